"""Scenes made from assemblies."""

from __future__ import annotations

from ._tegotae import Assembly, Scene


def scene_of(assembly: Assembly, hold: str) -> Scene:
    """Returns a scene with all parts of `assembly`, at their poses. The pen holds the part named `hold`.

    Raises Error (kind "setting") when there is no such part; the message lists the names that there are.
    """
    scene = Scene()
    for part in assembly.parts:
        scene.add_fixed(part.name, part.mesh, part.pose)
    scene.hold(hold)
    return scene
