"""Recordings as columns."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._tegotae import recording_columns


@dataclass(frozen=True)
class Recording:
    """A recording: n rows, one for each certified sub-step of a tick of the contact loop.

    Attributes
    ----------
    path : str
        Of the file.
    info : dict
        What it says of itself: scene, held, resolver, program, suspended, follows, goes_on, goal.
    damage : str
        What is wrong with its end; empty when it is whole.
    tick : (n,) uint64
        Number of the tick.
    substep : (n,) uint32
        Number of the piece in its tick.
    t : (n,) float64
        s.
    pen, part : (n, 4, 4) float64
        Y and X, m: where the pen wants the held part's own frame, and where it is.
    wrench : (n, 6) float64
        Force (N) and torque (N m) on the pen at the held part's center of mass, world axes.
    contacts : (n,) int32
        Pairs of features in contact.
    gap : (n,) float64
        m, smallest that is known; inf when nothing is near.
    tick_us : (n,) float64
        Time that the tick took; 0 in simulated time.
    lag_reason : (n,) uint8
        0 none, 1 contact, 2 time, 3 capacity, 4 suspended.
    forces : (k,) structured
        The contacts that carry force, of all rows (MCAP only): row, part, point (m), normal, gap (m), force (N),
        friction (N), mu, slides.
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
    """Reads a recording, CSV or MCAP. One whose end is missing is read up to there, and `damage` says so.

    Other Python threads go on meanwhile. Raises Error with file and line for anything else that is wrong.
    """
    return Recording(**recording_columns(path))
