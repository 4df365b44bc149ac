"""A path by which a part comes out of an assembly, or goes to a goal."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._programs import call
from ._tables import number, pose_text, poses_of, read_table


@dataclass(frozen=True)
class Plan:
    """What a planner found.

    Attributes
    ----------
    found : bool
        There is a path, and it is proved free.
    path : (n, 4, 4) float64
        X, m: where the held part's own frame goes, a row every 10 ms at 20 mm/s. Without a solution: the way to the
        farthest pose that was reached.
    t : (n,) float64
        s, of each pose.
    clearance : float
        m: the whole path is proved to leave this much to every other part; 0 without a solution.
    distance : (n,) float64
        m, measured: from the pose to the nearest part.
    nearest : (n,) str
        Name of that part.
    in_the_way : dict of str to int
        How many motions of the search each part stopped, those that stopped most first.
    summary : dict
        As `tegotae plan --json`.
    """

    found: bool
    path: NDArray[np.float64]
    t: NDArray[np.float64]
    clearance: float
    distance: NDArray[np.float64]
    nearest: NDArray[np.str_]
    in_the_way: dict[str, int]
    summary: dict[str, Any]


def plan(
    scene: str | os.PathLike[str],
    *,
    hold: str | None = None,
    goal: ArrayLike | None = None,
    clearance: float = 0.0,
    seed: int = 1,
    iterations: int | None = None,
    seconds: float | None = None,
    to: str | os.PathLike[str] | None = None,
) -> Plan:
    """Looks for a path of the held part, as `tegotae plan` does, in a process of its own.

    Other Python threads go on meanwhile; Ctrl-C ends it.

    Parameters
    ----------
    scene : str or os.PathLike
        Scene file.
    hold : str, optional
        Name of the part that is to move; None: the scene's held one.
    goal : (4, 4) array of float, optional
        Where its own frame is to go, m; None: out of all other parts.
    clearance : float
        m, that the path is to leave at least.
    seed : int
        The same seed, scene and build give the same path, unless `seconds` ends the search.
    iterations : int, optional
        Of the search, at most; None: 20 000.
    seconds : float, optional
        s, that the search may take; None: only iterations end it.
    to : str or os.PathLike, optional
        Folder that keeps what the program writes: path.csv, path.glb, script.csv, recording.csv, plan.json.

    Returns
    -------
    Plan
        Also when none was found: what is in the way, and how far it got.

    Raises
    ------
    Error
        The scene or the goal cannot be used, or this build has no planner.
    """
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.fspath(to) if to is not None else temporary
        command = ["plan", os.fspath(scene), "--json", "--to", folder, "--seed", str(seed)]
        command += ["--clearance", "%.17gm" % clearance]
        command += ["--hold", hold] if hold is not None else []
        command += ["--goal=" + pose_text(goal)] if goal is not None else []
        command += ["--iterations", str(iterations)] if iterations is not None else []
        command += ["--seconds", repr(float(seconds))] if seconds is not None else []
        _, out = call(command)
        summary = json.loads(out)
        table = read_table(os.path.join(folder, "path.csv"))
        return Plan(
            found=summary["found"],
            path=poses_of(table),
            t=np.array(table["t"], float),
            clearance=summary["clearance_m"],
            distance=np.array([number(v) for v in table["clearance"]]),
            nearest=np.array(table["part"]),
            in_the_way={one["part"]: one["stops"] for one in summary["in_the_way"]},
            summary=summary,
        )
