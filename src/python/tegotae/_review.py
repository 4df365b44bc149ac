"""What a recording tells about the assembly."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._tegotae import SceneFile, review_columns


@dataclass(frozen=True)
class Review:
    """Does the part go, along which way, how close to what, with how much force.

    Arrays are in the order of C, may be written, and belong to nobody else.

    Attributes
    ----------
    goes : bool
        The part gets where it should. False too where nothing can be said: see `outcome`.
    outcome : str
        "goes", "does not go", or "open": there is no goal, it is where the part began, or the recording ends before its
        script does.
    verdict : str
        The same in a sentence.
    evidence : list of str
        What speaks for it, a line each.
    t : (n,) float64
        s, of each pose that was looked at.
    path : (n, 4, 4) float64
        X, m: where the held part's own frame was.
    clearance : (n,) float64
        m, distance to the nearest part.
    part : (n,) int32
        Number of that part, index into `parts`; -1: there is none.
    parts : list of str
        Names of the scene's parts, by their numbers.
    force, torque : (n,) float64
        N and N m, felt.
    assembly_force : (m,) structured or None
        Of the assembly over depth, a row for each of 200 segments of the way; nan where the part was not seen moving
        so. None: the recording has no contact forces (MCAP has those of "qp"). Fields, float64: `depth`, m along the
        way, the segment's middle; and in N, positive against the motion: `insertion` and `insertion_peak`, mean and
        largest as it went on; `friction`, what of `insertion` is friction; `seating`, mean as it stood at the deepest;
        `pull_out` and `pull_out_peak`, mean and largest as it came back.
    report : str or None
        Path of the HTML report, where one was asked for.
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

    It is made in this process on all processors, and no file is written without `report`. Other Python threads go on
    meanwhile; Ctrl-C ends it with KeyboardInterrupt.

    Parameters
    ----------
    recording : str or os.PathLike
        CSV or MCAP, of a run of a scene file.
    scene : str, os.PathLike or SceneFile, optional
        Its scene file, or that in memory; None: the one that the recording names.
    goal : (4, 4) array of float, optional
        Where the held part's own frame was to go, m; None: where the scene's script ends.
    report : str or os.PathLike, optional
        Also write the HTML report here.

    Raises
    ------
    Error
        The recording or its scene cannot be used.
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
