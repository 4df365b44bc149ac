#!/usr/bin/env bash
# The Python package as its users get it: test_wheel.sh BUILD_FOLDER [STEP_FILE]. Builds the wheel in BUILD_FOLDER, installs it
# in a virtual environment, and runs there the tests of the package and the code of docs/python.md. Exit code 77, with the
# reason, where Python's packages cannot be had.
set -euo pipefail
build=$(mkdir -p "${1:?usage: test_wheel.sh BUILD_FOLDER [STEP_FILE]}" && realpath "$1")
step=${2:+$(realpath "$2")}
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
root=$here/../..

skip() { echo "SKIPPED: $*"; exit 77; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv --clear "$build/venv" 2>"$work/log" || skip "no virtual environment: $(tail -n 1 "$work/log")"
# Always at the same place: its path is in the command lines that ccache knows.
PATH=$build/venv/bin:$PATH
export PIP_DISABLE_PIP_VERSION_CHECK=1
# What the package needs to build and to run, what the tests need, and what the document shows.
pip install -q scikit-build-core nanobind numpy pytest mypy matplotlib >"$work/log" 2>&1 ||
  skip "PyPI cannot be reached: $(tail -n 1 "$work/log")"

# The compiler and the command lines of the main build, so that ccache has the objects. A tree that is kept builds what
# changed.
export CC=${CC:-cc} CXX=${CXX:-c++}
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-2}
pip wheel -q --no-deps --no-build-isolation -w "$work/wheels" -C build-dir="$build" \
  -C cmake.define.TEGOTAE_WARNINGS_AS_ERRORS=ON "$root" >"$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
echo "wheel: $(cd "$work/wheels" && du -h -- *.whl)"
pip install -q --no-deps "$work"/wheels/*.whl

cd "$work"
TEGOTAE_MODELS=$root/models python -m pytest -q -p no:cacheprovider "$here/test_package.py"
# The stubs have all that a program uses, and nothing that mypy cannot tell.
python -m mypy --strict --cache-dir="$work/mypy" -p tegotae
python -m mypy --strict --cache-dir="$work/mypy" "$here/typed_program.py"
python "$here/run_document.py" "$root/docs/python.md" "$root/models" ${step:+"$step"}
