"""Tables and poses as the programs write and read them."""

from __future__ import annotations

import csv

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._error import Error


def number(text: str) -> float:
    return float(text) if text else float("nan")


def read_table(path: str) -> dict[str, list[str]]:
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def poses_of(table: dict[str, list[str]]) -> NDArray[np.float64]:
    w, x, y, z = (np.array(table[k], float) for k in ("qw", "qx", "qy", "qz"))
    poses = np.zeros((len(w), 4, 4))
    poses[:, 0, 0], poses[:, 0, 1], poses[:, 0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    poses[:, 1, 0], poses[:, 1, 1], poses[:, 1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    poses[:, 2, 0], poses[:, 2, 1], poses[:, 2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    for axis, name in enumerate(("px", "py", "pz")):
        poses[:, axis, 3] = np.array(table[name], float)
    poses[:, 3, 3] = 1
    return poses


def pose_text(pose: ArrayLike) -> str:
    """The pose as the program reads it: X,Y,Z,QW,QX,QY,QZ."""
    X = np.asarray(pose, float)
    if X.shape != (4, 4):
        raise Error("the shape of a pose is %s, not (4, 4)" % (X.shape,), "setting")
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
