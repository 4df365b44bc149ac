"""What a recording tells about the assembly."""

from __future__ import annotations

import csv
import os
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._error import Error
from ._programs import program

_DONE, _DOES_NOT_GO = 0, 1


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


def _number(text: str) -> float:
    return float(text) if text else float("nan")


def _table(path: str) -> dict[str, list[str]]:
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def _poses(table: dict[str, list[str]]) -> NDArray[np.float64]:
    w, x, y, z = (np.array(table[k], float) for k in ("qw", "qx", "qy", "qz"))
    poses = np.zeros((len(w), 4, 4))
    poses[:, 0, 0], poses[:, 0, 1], poses[:, 0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    poses[:, 1, 0], poses[:, 1, 1], poses[:, 1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    poses[:, 2, 0], poses[:, 2, 1], poses[:, 2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    for axis, name in enumerate(("px", "py", "pz")):
        poses[:, axis, 3] = np.array(table[name], float)
    poses[:, 3, 3] = 1
    return poses


def _forces(path: str) -> NDArray[np.void]:
    table = _table(path)
    rows = np.empty(len(next(iter(table.values()))), dtype=[(name, "f8") for name in table])
    for name, values in table.items():
        rows[name] = [_number(v) for v in values]
    return rows


def _goal(pose: ArrayLike) -> str:
    """The pose as the program reads it: X,Y,Z,QW,QX,QY,QZ."""
    X = np.asarray(pose, float)
    if X.shape != (4, 4):
        raise Error("goal: the shape is %s, not (4, 4)" % (X.shape,), "setting")
    R = X[:3, :3]
    # The row of 4 q qT whose diagonal is largest, so that nothing small is divided by.
    k = np.array(
        [
            [1 + np.trace(R), R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
            [R[2, 1] - R[1, 2], 1 + 2 * R[0, 0] - np.trace(R), R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
            [R[0, 2] - R[2, 0], R[0, 1] + R[1, 0], 1 + 2 * R[1, 1] - np.trace(R), R[1, 2] + R[2, 1]],
            [R[1, 0] - R[0, 1], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], 1 + 2 * R[2, 2] - np.trace(R)],
        ]
    )
    row = k[np.argmax(np.diag(k))]
    q = row / np.linalg.norm(row)
    return ",".join(repr(float(v)) for v in (*X[:3, 3], *q))


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
        command = [program("tegotae"), "review", os.fspath(recording)]
        command += [os.fspath(scene)] if scene is not None else []
        command += ["--out", os.fspath(report) if report is not None else page, "--csv", path]
        command += ["--goal=" + _goal(goal)] if goal is not None else []
        command += ["--forces", force] if forces else []
        done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
        if done.returncode not in (_DONE, _DOES_NOT_GO) or not os.path.exists(path):
            lines = done.stderr.strip().splitlines()
            raise Error(lines[-1] if lines else "tegotae review ended with code %d" % done.returncode, "file")
        table = _table(path)
        lines = [line.strip() for line in done.stdout.splitlines()]
        return Review(
            goes=done.returncode == _DONE,
            verdict=lines[0],
            evidence=[line for line in lines[1:] if not line.startswith("report: ")],
            t=np.array(table["t"], float),
            path=_poses(table),
            clearance=np.array([_number(v) for v in table["clearance"]]),
            nearest=np.array(table["part"]),
            force=np.array(table["force"], float),
            torque=np.array(table["torque"], float),
            assembly_force=_forces(force) if forces else None,
            report=os.fspath(report) if report is not None else None,
        )
