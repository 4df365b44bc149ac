#!/usr/bin/env bash
# The shared library: test_shared.sh BUILD_FOLDER. Built in BUILD_FOLDER, used like the static one, and it shows the
# public interface only.
set -euo pipefail
build=${1:?usage: test_shared.sh BUILD_FOLDER}
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")

fail() { echo "test_shared: $*" >&2; exit 1; }

launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake -S "$here/../.." -B "$build" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DTEGOTAE_BUILD_APPS=OFF \
  -DTEGOTAE_BUILD_TESTS=OFF "${launcher[@]}" >/dev/null
cmake --build "$build" --parallel 2 >/dev/null
bash "$here/use_package.sh" "$build"

library=$(realpath "$build/libtegotae.so")
readelf -d "$library" | grep -q "SONAME.*libtegotae.so.0.1" || fail "no SONAME"
symbols=$(nm -DC --defined-only "$library" | cut -d ' ' -f 3-)
for public in "tegotae::HapticLoop::step(" "tegotae::load_mesh(" "typeinfo for tegotae::Error" "vtable for tegotae::SimulatedDevice"; do
  grep -qF "$public" <<<"$symbols" || fail "$public is hidden"
done
for private in tegotae::ContactLoop:: tegotae::PatchFront:: tegotae::LpSolver:: fcl:: toml:: Assimp::; do
  if grep -E "^[^<(]*$private" <<<"$symbols"; then fail "$private is shown"; fi
done
echo "shown symbols: $(wc -l <<<"$symbols")"
