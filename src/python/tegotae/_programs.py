"""Where the programs are that come with the package."""

from __future__ import annotations

import os
import shutil
import sysconfig

from ._error import Error


def program(name: str) -> str:
    """Path of the program `name`: where this Python's scripts are, else in PATH. Raises Error when it is not there."""
    schemes = [sysconfig.get_default_scheme(), sysconfig.get_preferred_scheme("user")]
    for folder in [sysconfig.get_path("scripts", scheme) for scheme in schemes]:
        path = os.path.join(folder, name)
        if os.access(path, os.X_OK):
            return path
    found = shutil.which(name)
    if found is None:
        raise Error("the program " + name + " is neither with this Python's scripts nor in PATH", "file", name)
    return found
