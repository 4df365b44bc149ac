"""What the tests of studies share: a study whose cases are cheap, and programs that may be absent."""
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKIPPED = 77
# With HyperShell, where tests/run.sh could install it.
PYTHON_PROGRAMS = os.path.join(ROOT, "build", "python", "bin")

CUBE = """v -5 -5 -5
v 5 -5 -5
v 5 5 -5
v -5 5 -5
v -5 -5 5
v 5 -5 5
v 5 5 5
v -5 5 5
f 1 4 3
f 1 3 2
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
"""
# A block a little over a floor, which it is to come down to.
SCENE = """unit = "mm"
[[part]]
name = "floor"
mesh = "cube.obj"
[[part]]
name = "block"
mesh = "cube.obj"
held = true
position = [0, 0, 0.0110]
"""
# The two values of mu and the two operators are four cases each time.
STUDY = """scenes = ["scene.toml"]
goal = "0,0,0.01001"
seconds = %d
repeats = %d

[parameters]
operator = ["hasty", "average"]
mu = [0, 0.2]
offset = { uniform = [0, 1e-3] }
tilt_deg = { tolerance = [0, 4] }

[[parameters.inward]]
part = "block"
by = { tolerance = [-1e-5, 1e-5] }
"""


def write_study(folder, cases, seconds=4):
    """The path of a study of so many cases, at least four. In four seconds about half of them reach the goal."""
    for name, text in (("cube.obj", CUBE), ("scene.toml", SCENE), ("study.toml", STUDY % (seconds, cases // 4))):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return os.path.join(folder, "study.toml")


def environment():
    """With HyperShell's programs on the path, and all that it writes in the study's folder."""
    path = os.environ.get("PATH", "")
    # Where SHELL is not set, GNU parallel runs each job by the program that called it, here Python, and reports success.
    shell = os.environ.get("SHELL") or "/bin/sh"
    return dict(os.environ, PATH=path + os.pathsep + PYTHON_PROGRAMS, SHELL=shell, HYPERSHELL_LOGGING_LEVEL="error")


def program(name):
    return shutil.which(name, path=environment()["PATH"])


def skip(why):
    print("SKIPPED: " + why)
    sys.exit(SKIPPED)


def run(command, **more):
    """Its output; ends the test when it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment(), **more)
    if done.returncode != 0:
        sys.exit("%s ended with %d:\n%s" % (" ".join(map(str, command)), done.returncode, done.stdout))
    return done.stdout


def read(*path):
    with open(os.path.join(*path), "rb") as file:
        return file.read()
