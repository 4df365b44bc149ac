"""A program that uses what the package has, for mypy --strict alone: it is not run."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import tegotae


def at(x: float, y: float, z: float) -> NDArray[np.float64]:
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


class Falling:
    def __init__(self) -> None:
        self.X = at(0, 0, 0.03)

    def write(self, wrench: NDArray[np.float64]) -> None:
        self.X[2, 3] += 1e-6 * wrench[2]

    def read(self) -> NDArray[np.float64]:
        return self.X


def watch(rig: tegotae.Rig) -> None:
    print(rig.time, rig.report.lag_reason)


scene = tegotae.Scene()
number: int = scene.add_fixed("hole", tegotae.load_mesh(Path("models/hole_20.obj"), "mm"))
scene.add_held("peg", tegotae.load_mesh("models/peg_0.94.obj", "mm"), at(0, 0, 0.03), mass=0.1)
scene.friction = 0.2
scene.l_min = None
scene.gravity = [0, 0, -9.81]
g: NDArray[np.float64] = scene.gravity
pen: tegotae.Pen = tegotae.ScriptPen([0, 0.5], [at(0.004, 0, 0.03), at(0.004, 0, 0.02)])
with tegotae.Rig(scene, pen) as rig:
    rig.run(1.5, watch)
    rig.step(3)
    contacts: NDArray[np.void] = rig.contacts
    force: float = float(contacts["force"].sum())
    w: NDArray[np.float64] = rig.wrench
    change: tegotae.Change = rig.change(scene.copy())
    state: str = change.wait(0.1)
own = tegotae.PythonPen(Falling(), max_force=3.0)
rate: float = own.rate
summary: dict[str, Any] = tegotae.run("models/peg.toml", record=Path("peg.mcap"))
file = tegotae.load_scene("models/peg.toml", hold="peg")
review: tegotae.Review = tegotae.review("peg.mcap", scene=file)
clearance: NDArray[np.float64] = review.clearance
plan: tegotae.Plan = tegotae.plan(file.scene, goal=np.eye(4), clearance=1e-4)
recording: tegotae.Recording = tegotae.read_recording("peg.mcap")
part: NDArray[np.float64] = recording.part
assembly: tegotae.Assembly = tegotae.read_assembly("a.step")
names: list[str] = [p.name for p in assembly.parts]
color: list[float] | None = assembly.parts[0].color
s2: tegotae.Scene = tegotae.scene_of(assembly, hold="Welle")
try:
    tegotae.load_scene("x")
except tegotae.Error as e:
    print(e.kind, e.file, e.line, e.key, e.part)
