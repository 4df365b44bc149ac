"""Six-degree-of-freedom haptic rendering of rigid parts that never pass through each other.

Poses are (4, 4) float64 arrays X_WF: from a part's own frame to the world, lengths in m. Everything is in SI units.
"""

from ._error import Error
from ._plan import Plan, plan
from ._recording import Recording, read_recording
from ._review import Review, review
from ._scenes import scene_of
from ._tegotae import (
    Assembly,
    AssemblyPart,
    Change,
    Mesh,
    Pen,
    PythonPen,
    Report,
    Rig,
    Scene,
    SceneFile,
    ScriptPen,
    contact_dtype,
    load_mesh,
    load_scene,
    read_assembly,
    run,
)
from ._tegotae import version as __version__

__all__ = [
    "Assembly",
    "AssemblyPart",
    "Change",
    "Error",
    "Mesh",
    "Pen",
    "Plan",
    "PythonPen",
    "Recording",
    "Report",
    "Review",
    "Rig",
    "Scene",
    "SceneFile",
    "ScriptPen",
    "__version__",
    "contact_dtype",
    "load_mesh",
    "load_scene",
    "plan",
    "read_assembly",
    "read_recording",
    "review",
    "run",
    "scene_of",
]
