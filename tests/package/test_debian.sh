#!/usr/bin/env bash
# The Debian packages of BUILD_FOLDER: made, unpacked, used. test_debian.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "${1:?usage: test_debian.sh BUILD_FOLDER}")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")

fail() { echo "test_debian: $*" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$build" && cpack -G DEB -B "$work" >"$work/log" 2>&1) || { cat "$work/log"; fail cpack; }
mapfile -t packages < <(find "$work" -maxdepth 1 -name '*.deb' | sort)
[ "${#packages[@]}" = 2 ] || fail "made: ${packages[*]}"
mkdir "$work/unpacked"
for p in "${packages[@]}"; do
  echo "$(basename "$p"): $(dpkg-deb -f "$p" Depends)"
  dpkg -x "$p" "$work/unpacked"
  # Every dependency is a package that is installed here, or the package would not install.
  while read -r name; do
    dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null | grep -q '^installed$' || fail "depends on $name"
  done < <(dpkg-deb -f "$p" Depends | tr ',' '\n' | sed 's/|.*//; s/(.*//; s/ //g')
done
dpkg-deb -f "$work"/tegotae_*.deb Depends | grep -q libassimp || fail "the programs do not ask for assimp's library"
dpkg-deb -f "$work"/libtegotae-dev_*.deb Depends | grep -q zlib1g-dev || fail "libtegotae-dev lacks zlib1g-dev"

bin=$work/unpacked/usr/bin
"$bin/tegotae" --version | grep -qE '^tegotae [0-9]+[.][0-9]+[.][0-9]+$' || fail "tegotae --version"
"$bin/tegotae" check "$root/models/peg_0.94.obj" | grep -q closed || fail "tegotae check"
quiet=$work/log
cmake -S "$root/apps/examples" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/unpacked/usr" >"$quiet" 2>&1 &&
  cmake --build "$work/build" --target meshes_from_memory >>"$quiet" 2>&1 || { cat "$quiet"; fail "the example"; }
grep -q "^tegotae_DIR:PATH=$work/unpacked/" "$work/build/CMakeCache.txt" || fail "another tegotae was found"
"$work/build/meshes_from_memory" | grep "400 ms"
