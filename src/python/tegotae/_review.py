"""What a recording tells about the assembly."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._programs import call
from ._tables import number, pose_text, poses_of, read_table


@dataclass(frozen=True)
class Review:
    """Does the part go, along which way, how close to what, with how much force.

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
    nearest : (n,) str
        Name of that part.
    force, torque : (n,) float64
        N and N m, felt.
    assembly_force : (m,) structured or None
        Of the assembly over depth (`forces=True`), a row for each of 200 segments of the way; nan where the part was not
        seen moving so. Fields, float64: `depth_mm`, mm along the way, the segment's middle; and in N, positive against
        the motion: `insertion_n` and `insertion_peak_n`, mean and largest as it went on; `friction_n`, what of
        `insertion_n` is friction; `seating_n`, mean as it stood at the deepest; `pull_out_n` and `pull_out_peak_n`, mean
        and largest as it came back; `low_n` and `high_n`, `insertion_n` with the least and the most friction of `--mu`
        (nan here).
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
    nearest: NDArray[np.str_]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    assembly_force: NDArray[np.void] | None
    report: str | None


def _forces(path: str) -> NDArray[np.void]:
    table = read_table(path)
    rows = np.empty(len(next(iter(table.values()))), dtype=[(name, "f8") for name in table])
    for name, values in table.items():
        rows[name] = [number(v) for v in values]
    return rows


def review(
    recording: str | os.PathLike[str],
    scene: str | os.PathLike[str] | None = None,
    *,
    goal: ArrayLike | None = None,
    forces: bool = False,
    report: str | os.PathLike[str] | None = None,
) -> Review:
    """Reports on a recording, as `tegotae review` does, in a process of its own.

    Parameters
    ----------
    recording : str or os.PathLike
        CSV or MCAP, of a run of a scene file.
    scene : str or os.PathLike, optional
        Its scene file; None: the one that the recording names.
    goal : (4, 4) array of float, optional
        Where the held part's own frame was to go, m; None: where the scene's script ends.
    forces : bool
        Also the force of the assembly over depth, of a recording in MCAP with "qp".
    report : str or os.PathLike, optional
        Also keep the HTML report here.

    Raises
    ------
    Error
        The recording or its scene cannot be used.
    """
    with tempfile.TemporaryDirectory() as folder:
        path, page, force = (os.path.join(folder, name) for name in ("path.csv", "report.html", "forces.csv"))
        command = ["review", "--json", os.fspath(recording)]
        command += [os.fspath(scene)] if scene is not None else []
        command += ["--out", os.fspath(report) if report is not None else page, "--csv", path]
        command += ["--goal=" + pose_text(goal)] if goal is not None else []
        command += ["--forces", force] if forces else []
        _, out = call(command)
        table = read_table(path)
        said = json.loads(out)
        return Review(
            goes=said["outcome"] == "goes",
            outcome=said["outcome"],
            verdict=said["headline"],
            evidence=[line["text"] for line in said["evidence"]],
            t=np.array(table["t"], float),
            path=poses_of(table),
            clearance=np.array([number(v) for v in table["clearance"]]),
            nearest=np.array(table["part"]),
            force=np.array(table["force"], float),
            torque=np.array(table["torque"], float),
            assembly_force=_forces(force) if forces else None,
            report=os.fspath(report) if report is not None else None,
        )
