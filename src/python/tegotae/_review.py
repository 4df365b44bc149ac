"""What a recording tells about the assembly."""

from __future__ import annotations

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
        The part gets where it should.
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
        Of the assembly over depth (`forces=True`): depth_mm, insertion_n, insertion_peak_n, friction_n, pull_out_n,
        low_n, high_n; nan where the part was not seen moving so.
    report : str or None
        Path of the HTML report, where one was asked for.
    """

    goes: bool
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
        command = ["review", os.fspath(recording)]
        command += [os.fspath(scene)] if scene is not None else []
        command += ["--out", os.fspath(report) if report is not None else page, "--csv", path]
        command += ["--goal=" + pose_text(goal)] if goal is not None else []
        command += ["--forces", force] if forces else []
        code, out = call(command)
        table = read_table(path)
        lines = [line.strip() for line in out.splitlines()]
        return Review(
            goes=code == 0,
            verdict=lines[0],
            evidence=[line for line in lines[1:] if not line.startswith("report: ")],
            t=np.array(table["t"], float),
            path=poses_of(table),
            clearance=np.array([number(v) for v in table["clearance"]]),
            nearest=np.array(table["part"]),
            force=np.array(table["force"], float),
            torque=np.array(table["torque"], float),
            assembly_force=_forces(force) if forces else None,
            report=os.fspath(report) if report is not None else None,
        )
