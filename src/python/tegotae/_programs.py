"""Paths of the programs that come with the package."""

from __future__ import annotations

import os
import shutil
import sysconfig

from ._error import Error


def program(name: str) -> str:
    """Returns the path of the program `name`: among this Python's scripts, else in PATH.

    Raises Error (kind "file") when neither has it.
    """
    schemes = [sysconfig.get_default_scheme(), sysconfig.get_preferred_scheme("user")]
    for folder in [sysconfig.get_path("scripts", scheme) for scheme in schemes]:
        path = os.path.join(folder, name)
        if os.access(path, os.X_OK):
            return path
    found = shutil.which(name)
    if found is None:
        raise Error("the program " + name + " is neither with this Python's scripts nor in PATH", "file", name)
    return found
