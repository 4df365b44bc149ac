"""Plans: a path by which a part leaves an assembly or reaches a goal."""

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
    """Result of plan(). Its arrays are C-contiguous and writable, and share no memory with others.

    Attributes
    ----------
    found : bool
        Whether there is a path. The whole path is proved free.
    path : (n, 4, 4) float64
        Poses X_WF of the held part's own frame, m, every 10 ms at 20 mm/s. Without a solution: the path to the farthest
        pose that the search reached.
    t : (n,) float64
        Time of each pose, s.
    clearance : float
        Clearance to every other part that is proved for the whole path, m; 0 without a solution.
    distance : (n,) float64
        Measured distance from each pose to the nearest part, m; inf when there is none.
    part : (n,) int32
        Number of that part, an index into `parts`; -1: there is none.
    parts : list of str
        Names of the scene's parts, in the order of their numbers.
    in_the_way : dict of str to int
        Number of motions of the search that each part stopped, the largest first.
    summary : dict
        The same as `tegotae plan --json`.
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
    """Searches for a path of the held part, as `tegotae plan` does.

    The planner runs in this process. It writes files only when `to` is given. Other Python threads continue meanwhile;
    calls of plan() from several threads run one after the other. Ctrl-C ends the call with KeyboardInterrupt.

    Parameters
    ----------
    scene : str, os.PathLike, SceneFile or Scene
        A scene file, or a scene in memory, which does not change.
    hold : str, optional
        Name of the part to move; None: the scene's held part.
    goal : (4, 4) array of float, optional
        Goal pose X_WF of that part's own frame, m; None: free of all other parts.
    clearance : float
        Smallest clearance that the path must leave, m; 0: what the contact loop leaves, 1.1 um.
    seed : int
        The same seed, scene and build give the same path, unless `seconds` ends the plan.
    iterations : int, optional
        Largest number of iterations of the search; None: 20 000, or unbounded when `seconds` is given.
    seconds : float, optional
        Time that the plan may take, s; None: only `iterations` ends its search.
    to : str or os.PathLike, optional
        Folder for the files that `tegotae plan` writes: path.csv, path.glb, script.csv, recording.csv, plan.json. The
        scene must then come from a file, because the recording names it.

    Returns
    -------
    Plan
        Also without a solution: it then says what is in the way, and how far the search got.

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
