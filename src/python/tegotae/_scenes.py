"""Scenes of what was read."""

from __future__ import annotations

from ._tegotae import Assembly, Scene


def scene_of(assembly: Assembly, hold: str) -> Scene:
    """A scene of all parts of `assembly`, of which the pen holds the one called `hold`.

    Raises Error when there is no such part; the message names those that there are.
    """
    scene = Scene()
    for part in assembly.parts:
        scene.add_fixed(part.name, part.mesh, part.pose)
    scene.hold(hold)
    return scene
