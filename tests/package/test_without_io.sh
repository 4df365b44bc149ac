#!/usr/bin/env bash
# The library for programs that bring meshes from memory: test_without_io.sh BUILD_FOLDER. Configures, builds, installs and
# uses it without the libraries of file formats: CMake is told not to find them, and no object may name one.
set -euo pipefail
build=${1:?usage: test_without_io.sh BUILD_FOLDER}
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
build=$(mkdir -p "$build" && realpath "$build")

fail() { echo "test_without_io: $*" >&2; exit 1; }
quietly() { "$@" >"$build/log" 2>&1 || { cat "$build/log"; fail "$*"; }; }

launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
absent=()
for package in assimp draco meshoptimizer pugixml tomlplusplus ZLIB zstd nlohmann_json OpenCASCADE; do
  absent+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
# Warnings as errors: the same command lines as in the main build, so that ccache has the objects.
quietly cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DTEGOTAE_IO=OFF -DTEGOTAE_BUILD_APPS=OFF \
  -DTEGOTAE_BUILD_TESTS=OFF -DTEGOTAE_WARNINGS_AS_ERRORS=ON "${absent[@]}"
quietly cmake --build "$build" --parallel 2
quietly cmake --install "$build" --prefix "$build/stage"
cp -r "$root/apps/examples" "$build/examples"
quietly cmake -S "$build/examples" -B "$build/use" -DCMAKE_PREFIX_PATH="$build/stage" -DCMAKE_BUILD_TYPE=Release \
  "${absent[@]}" "${launcher[@]}"
quietly cmake --build "$build/use" --target meshes_from_memory
"$build/use/meshes_from_memory" | grep -E "400 ms: pen at +4[.]0 mm, cube at +10[.]0[0-9]+ mm, +[1-9] contacts"
needed=$(readelf -d "$build/use/meshes_from_memory" | grep NEEDED)
if grep -E 'assimp|TK[A-Z]|zstd|libz[.]|pugixml|minizip|toml' <<<"$needed"; then
  fail "the program loads the above"
fi

# The demo, as .ci/setup.sh configures it, is to be there in minutes on a machine that has nothing.
quietly cmake -S "$root" -B "$build/demo" -DCMAKE_BUILD_TYPE=Release -DTEGOTAE_IO=OFF -DTEGOTAE_BUILD_APPS=OFF \
  -DTEGOTAE_BUILD_TESTS=OFF -DTEGOTAE_BUILD_DEMO=ON -DTEGOTAE_INSTALL=OFF \
  -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${absent[@]}"
sources=$(grep -c '"file":' "$build/demo/compile_commands.json")
echo "the demo compiles $sources sources"
[ "$sources" -le 100 ] || fail "more than 100: it is to be there in minutes"
