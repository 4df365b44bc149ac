#!/usr/bin/env bash
# Tegotae by FetchContent: test_subproject.sh BUILD_FOLDER. Builds the library alone, and an example that runs.
set -euo pipefail
build=${1:?usage: test_subproject.sh BUILD_FOLDER}
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
# Warnings as errors: the same command lines as in the main build, so that ccache has the objects.
cmake -S "$here/subproject" -B "$build" -DTEGOTAE_SOURCE="$(realpath "$here/../..")" -DCMAKE_BUILD_TYPE=Release \
  -DTEGOTAE_WARNINGS_AS_ERRORS=ON "${launcher[@]}" >/dev/null
cmake --build "$build" --parallel 2 >/dev/null
"$build/touch" | grep "400 ms"
if DESTDIR=$build/stage cmake --install "$build" >/dev/null && [ -e "$build/stage" ]; then
  echo "a subproject installs $(find "$build/stage" -type f | head -n 3)" >&2
  exit 1
fi
