"""Recordings as columns."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._tegotae import recording_columns


@dataclass(frozen=True)
class Recording:
    """A recording of n rows, one for each certified sub-step of a tick of the contact loop.

    Its arrays are C-contiguous and writable, and share no memory with others.

    Attributes
    ----------
    path : str
        Path of the file.
    info : dict
        Metadata of the recording, each a text, empty when not known: `scene` (path of the scene file), `held` (name of
        the held part), `resolver`, `program` (that wrote it), `suspended` (parts that the held part overlapped at the
        start, and from which nothing keeps it apart), `follows` and `goes_on` (the recording that it continues, and the
        one that continues it), `goal` (pose X_WF: x, y, z in m, then the quaternion w, x, y, z), `goal_tolerance` (m),
        `judged_after` (s).
    damage : str
        What is wrong with the end of the recording; empty when it is whole.
    tick : (n,) uint64
        Number of the tick.
    substep : (n,) uint32
        Number of the sub-step in its tick, from 0.
    t : (n,) float64
        Time, s.
    pen, part : (n, 4, 4) float64
        Poses of the held part's own frame in the world, m: Y, where the pen wants it, and X, where it is.
    wrench : (n, 6) float64
        Wrench on the pen: force (N), then torque (N m) about the held part's center of mass, in the axes of the world.
    contacts : (n,) int32
        Number of feature pairs in contact.
    gap : (n,) float64
        Smallest known gap, m; inf when nothing is near.
    tick_us : (n,) float64
        Time that the tick took, us; 0 in simulated time.
    lag_reason : (n,) uint8
        Why the part lagged the pen: 0 none, 1 contact, 2 time, 3 capacity, 4 suspended.
    forces : (k,) structured
        Contacts that carry force, of all rows (MCAP only). Fields: `row` (index into the other arrays), `part` (number
        of the fixed part), `point` ((3,), m, world, on the held part), `normal` ((3,), unit, from the fixed to the held
        part, world), `gap` (m), `force` (N, along `normal`, on the held part), `friction` ((3,), N, world), `mu`
        (coefficient of friction), `slides` (the point slid).
    """

    path: str
    info: dict[str, str]
    damage: str
    tick: NDArray[np.uint64]
    substep: NDArray[np.uint32]
    t: NDArray[np.float64]
    pen: NDArray[np.float64]
    part: NDArray[np.float64]
    wrench: NDArray[np.float64]
    contacts: NDArray[np.int32]
    gap: NDArray[np.float64]
    tick_us: NDArray[np.float64]
    lag_reason: NDArray[np.uint8]
    forces: NDArray[np.void]

    def __len__(self) -> int:
        return len(self.t)


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Reads a recording, CSV or MCAP. Of a recording without its end it reads what there is, and `damage` says so.

    Other Python threads continue meanwhile. Raises Error (kind "file") for any other fault; its message names the file
    and the line (CSV) or byte (MCAP).
    """
    return Recording(**recording_columns(path))
