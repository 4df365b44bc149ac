"""Where the programs are that come with the package."""

from __future__ import annotations

import os
import shutil
import subprocess
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


def call(arguments: list[str]) -> tuple[int, str]:
    """Runs `tegotae` with these arguments. Its exit code, 0 or 1 (what was asked for is not so), and its stdout.

    Raises Error with what it says, when it cannot do it.
    """
    done = subprocess.run([program("tegotae"), *arguments], capture_output=True, encoding="utf-8", check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        lines = done.stderr.strip().splitlines()
        raise Error(lines[-1] if lines else "tegotae %s ended with code %d" % (arguments[0], done.returncode), "file")
    return done.returncode, done.stdout
