#!/usr/bin/env bash
# Uses the installed library the way a stranger does: use_package.sh BUILD_FOLDER.
# Installs BUILD_FOLDER, moves the result, and builds and runs apps/examples against it, outside of this tree, by
# find_package and by pkg-config.
set -euo pipefail
build=$(realpath "${1:?usage: use_package.sh BUILD_FOLDER}")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")

fail() { echo "use_package: $*" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for component in development library; do
  DESTDIR=$work/stage cmake --install "$build" --prefix /opt/tegotae --component "$component" >"$work/log" ||
    { cat "$work/log"; fail "cmake --install"; }
done
mv "$work/stage/opt/tegotae" "$work/moved"
rm -rf "$work/stage"
if grep -rIlE "$build|$root|/opt/tegotae" "$work/moved"; then fail "the files above know where they were built"; fi

quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "$*"; }; }

cp -r "$root/apps/examples" "$work/examples"
cd "$work/examples"
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
quietly cmake -S . -B build -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wshadow -Werror" "${launcher[@]}"
grep -q "^tegotae_DIR:PATH=$work/moved/" build/CMakeCache.txt || fail "another installed tegotae was found"
quietly cmake --build build --parallel 2

pkg_config_path=$work/moved/lib/pkgconfig:$work/moved/lib/$(gcc -print-multiarch 2>/dev/null)/pkgconfig

# What each of them must print; the numbers are coarse, the tests of the library look closely.
run() {
  local name=$1 expected=$2
  shift 2
  "build/$name" "$@" >"$work/out" || fail "$name failed: $(cat "$work/out")"
  grep -qE "$expected" "$work/out" || { cat "$work/out"; fail "$name did not print $expected"; }
  echo "$name: $(tail -n 1 "$work/out")"
}
(cd "$root" && "$work/examples/build/first_touch") >"$work/out" || fail "first_touch failed"
grep -qE "^500 ms: +[1-9][0-9]* contacts, +1[.][0-9]+ N up" "$work/out" || fail "first_touch printed: $(cat "$work/out")"
run from_c "contacts with part 0 carry [1-3][.]"
# Real time bounds the ticks of own_loop: on a busy machine the part lags, so contacts are not asked for.
run scripted_pen "600 ms: .* [1-9][0-9]* contacts, +[1-9][0-9.]* N up" "$root/models"
run own_loop "^[1-9][0-9]* servo ticks" "$root/models"
run custom_device "at rest: (1[.]9|2[.]0)[0-9] N up" "$root/models"
run custom_resolver "both pegs went ([0-9.]+) and .* mm down; never farther apart than 0[.][01]" "$root/models"
run viewer "remove: 401 parts, the held one goes to x = 2[45]" "$root/models"
run meshes_from_memory "400 ms: pen at +4[.]0 mm, cube at +10[.]0[0-9]+ mm, +[1-9] contacts"

# A program built for this very processor has other vector widths than the library. Its poses must not.
quietly ${CXX:-g++} -std=c++17 -O2 -march=native scripted_pen.cpp -o native $(PKG_CONFIG_PATH=$pkg_config_path pkg-config --cflags --libs tegotae)
build/scripted_pen "$root/models" >"$work/as_built"
LD_LIBRARY_PATH=$work/moved/lib:$work/moved/lib/$(gcc -print-multiarch) ./native "$root/models" >"$work/native"
cmp "$work/as_built" "$work/native" || fail "scripted_pen does something else when it is built with -march=native"

# The component backends, which comes with the static library.
if [ -n "$(find "$work/moved" -name libtegotae_backends.a)" ]; then
  mkdir "$work/backends"
  cat >"$work/backends/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.21)
project(backends LANGUAGES C CXX)
find_package(tegotae 0.1 REQUIRED COMPONENTS backends)
add_executable(inputs inputs.cpp)
target_link_libraries(inputs PRIVATE tegotae::backends)
END
  cat >"$work/backends/inputs.cpp" <<'END'
#include <cstdio>
#include <tegotae/core/error.hpp>
#include <tegotae/device/input_devices.hpp>

int main() {
  tegotae::RateControlSettings wrong;
  wrong.speed = -1;
  for (const auto make : {tegotae::make_spacemouse, tegotae::make_gamepad}) {
    try {
      make(wrong);
    } catch (const tegotae::Error& e) {
      std::puts(e.what());
    }
  }
}
END
  quietly cmake -S "$work/backends" -B "$work/backends/build" -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_BUILD_TYPE=Release
  quietly cmake --build "$work/backends/build"
  [ "$("$work/backends/build/inputs" | wc -l)" = 2 ] || fail "the backends took a negative speed"
fi

# A version of another interface is refused.
sed -i 's/find_package(tegotae 0.1 /find_package(tegotae 0.0 /' CMakeLists.txt
if cmake -S . -B build_other -DCMAKE_PREFIX_PATH="$work/moved" >/dev/null 2>&1; then fail "0.0 was taken for 0.1"; fi

export PKG_CONFIG_PATH=$pkg_config_path
pkg-config --exists tegotae || fail "pkg-config does not know tegotae"
# shellcheck disable=SC2046
quietly ${CXX:-g++} -std=c++17 -O1 meshes_from_memory.cpp -o pkg $(pkg-config --cflags --libs tegotae)
LD_LIBRARY_PATH=$work/moved/lib:$work/moved/lib/$(gcc -print-multiarch) ./pkg | grep -q "400 ms" || fail "the pkg-config build does not run"
echo "pkg-config: $(pkg-config --modversion tegotae)"
