"""Reviews: what a recording says about the assembly."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._tegotae import SceneFile, review_columns


@dataclass(frozen=True)
class Review:
    """Result of review(): whether the part reaches its goal, on which path, how close to which part, with what force.

    Its arrays are C-contiguous and writable, and share no memory with others.

    Attributes
    ----------
    goes : bool
        Whether the part reaches its goal. Also False when the recording does not decide it: see `outcome`.
    outcome : str
        "goes", "does not go", or "open": there is no goal, the goal is where the part began, or the recording ends
        before its script does.
    verdict : str
        The outcome in a sentence.
    evidence : list of str
        Findings behind the verdict, one line each.
    t : (n,) float64
        Time of each pose that the review examined, s.
    path : (n, 4, 4) float64
        Poses X_WF of the held part's own frame, m.
    clearance : (n,) float64
        Distance to the nearest part, m; inf when there is none.
    part : (n,) int32
        Number of that part, an index into `parts`; -1: there is none.
    parts : list of str
        Names of the scene's parts, in the order of their numbers.
    force, torque : (n,) float64
        Magnitudes of the felt force (N) and torque (N m).
    assembly_force : (m,) structured or None
        Force of the assembly over depth, one row for each of 200 segments of the path; nan where the part did not move
        in that way. None: the part did not move, or the recording has no contact forces (MCAP has those of "qp").
        Fields, float64: `depth` (m along the path, at the middle of the segment); and in N, positive against the
        motion: `insertion` and `insertion_peak` (mean and largest as the part went in), `friction` (the part of
        `insertion`, or of `pull_out` if the path leads out, that is friction), `seating` (mean as it stood at the
        deepest place), `pull_out` and `pull_out_peak` (mean and largest as it came out).
    report : str or None
        Path of the HTML report; None: none was requested.
    """

    goes: bool
    outcome: str
    verdict: str
    evidence: list[str]
    t: NDArray[np.float64]
    path: NDArray[np.float64]
    clearance: NDArray[np.float64]
    part: NDArray[np.int32]
    parts: list[str]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    assembly_force: NDArray[np.void] | None
    report: str | None


def review(
    recording: str | os.PathLike[str],
    scene: str | os.PathLike[str] | SceneFile | None = None,
    *,
    goal: ArrayLike | None = None,
    report: str | os.PathLike[str] | None = None,
) -> Review:
    """Reports on a recording, as `tegotae review` does.

    The review runs in this process on all processors. It writes a file only when `report` is given. Other Python
    threads continue meanwhile. Ctrl-C ends the call with KeyboardInterrupt.

    Parameters
    ----------
    recording : str or os.PathLike
        Recording (CSV or MCAP) of a run of a scene file.
    scene : str, os.PathLike or SceneFile, optional
        Scene file of that run, by its path or in memory; None: the file that the recording names.
    goal : (4, 4) array of float, optional
        Goal pose X_WF of the held part's own frame, m; None: the goal that the recording names, or else where the
        scene's script ends.
    report : str or os.PathLike, optional
        Path of the HTML report to write.

    Returns
    -------
    Review

    Raises
    ------
    Error
        The recording or its scene cannot be used, or the report cannot be written or would replace a file that was
        read.
    """
    found = review_columns(recording, scene, goal, report)
    said = json.loads(found["said"])
    return Review(
        goes=said["outcome"] == "goes",
        outcome=said["outcome"],
        verdict=said["headline"],
        evidence=[one["text"] for one in said["evidence"]],
        t=found["t"],
        path=found["path"],
        clearance=found["clearance"],
        part=found["part"],
        parts=found["parts"],
        force=found["force"],
        torque=found["torque"],
        assembly_force=found["assembly_force"],
        report=os.fspath(report) if report is not None else None,
    )
