"""A path by which a part comes out of an assembly, or goes to a goal."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._tegotae import Scene, SceneFile, plan_columns


@dataclass(frozen=True)
class Plan:
    """What a planner found. Arrays are in the order of C, may be written, and belong to nobody else.

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
    part : (n,) int32
        Number of that part, index into `parts`; -1: there is none.
    parts : list of str
        Names of the scene's parts, by their numbers.
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
    part: NDArray[np.int32]
    parts: list[str]
    in_the_way: dict[str, int]
    summary: dict[str, Any]


def plan(
    scene: str | os.PathLike[str] | SceneFile | Scene,
    *,
    hold: str | None = None,
    goal: ArrayLike | None = None,
    clearance: float = 0.0,
    seed: int = 1,
    iterations: int | None = None,
    seconds: float | None = None,
    to: str | os.PathLike[str] | None = None,
) -> Plan:
    """Looks for a path of the held part, as `tegotae plan` does.

    The planner is in this process and no file is written without `to`. Other Python threads go on meanwhile; plans of
    several threads are made one after the other. Ctrl-C ends it with KeyboardInterrupt.

    Parameters
    ----------
    scene : str, os.PathLike, SceneFile or Scene
        A scene file, or a scene in memory, which stays as it is.
    hold : str, optional
        Name of the part that is to move; None: the scene's held one.
    goal : (4, 4) array of float, optional
        Where its own frame is to go, m; None: out of all other parts.
    clearance : float
        m, that the path is to leave at least.
    seed : int
        The same seed, scene and build give the same path, unless `seconds` ends the search.
    iterations : int, optional
        Of the search, at most; None: 20 000, or any number where `seconds` is given.
    seconds : float, optional
        s, that the search may take; None: only iterations end it.
    to : str or os.PathLike, optional
        Folder that gets what the program writes: path.csv, path.glb, script.csv, recording.csv, plan.json. The scene is
        then one of a file, which the recording names.

    Returns
    -------
    Plan
        Also when none was found: what is in the way, and how far it got.

    Raises
    ------
    Error
        The scene or the goal cannot be used, or this build has no planner.
    """
    found = plan_columns(scene, hold or "", goal, clearance, seed, iterations, seconds, to)
    summary = json.loads(found["summary"])
    return Plan(
        found=summary["found"],
        path=found["path"],
        t=found["t"],
        clearance=summary["clearance_m"],
        distance=found["clearance"],
        part=found["part"],
        parts=found["parts"],
        in_the_way={one["part"]: one["stops"] for one in summary["in_the_way"]},
        summary=summary,
    )
