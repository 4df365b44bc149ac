#!/usr/bin/env bash
# Installs what is missing (Debian 12 or 13, apt), configures and builds: setup.sh [--browser] [--checks] [TARGET...]
# (everything without targets), or setup.sh --demo: what apps/demo.sh needs alone, in a build folder of its own.
# --browser adds what the tests need that are not daily: a browser, doxygen. --checks adds
# the tools of tests/checks.sh; without them its checks are skipped, so that one that cannot be had is no error.
# Shared by apps/demo.sh and tests/run.sh; a second call only builds what changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# ccache: the tests of the package and of the Python wheel compile the library again. pkg-config, dpkg-dev, file: the tests
# of the package. parallel: a test of studies.
packages=(g++ ccache cmake ninja-build libeigen3-dev libfcl-dev libccd-dev libxxhash-dev libassimp-dev libdraco-dev
          libmeshoptimizer-dev libpugixml-dev libminizip-dev zlib1g-dev libzstd-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
          libcivetweb-dev catch2 python3-venv python3-dev libspnav-dev libsdl2-dev libocct-data-exchange-dev libompl-dev
          pkg-config dpkg-dev file parallel)

browser=false
tools=()
newest=()
preset=release
options=(-DTEGOTAE_BUILD_APPS=ON -DTEGOTAE_BUILD_TESTS=ON)
for _ in 1 2; do
  case ${1:-} in
    --demo)
      packages=(g++ ccache cmake ninja-build libeigen3-dev libfcl-dev libccd-dev libxxhash-dev)
      preset=demo
      options=(-DTEGOTAE_IO=OFF -DTEGOTAE_BUILD_APPS=OFF -DTEGOTAE_BUILD_TESTS=OFF -DTEGOTAE_BUILD_DEMO=ON -DTEGOTAE_INSTALL=OFF)
      set -- demo
      break ;;
    --browser)
      browser=true
      packages+=(doxygen)
      # By command: Node may come from elsewhere, with npm in it.
      for command in node:nodejs npm:npm chromium:chromium; do
        command -v "${command%:*}" >/dev/null || packages+=("${command#*:}")
      done
      shift ;;
    --checks)
      tools=(clang-14 libclang-rt-14-dev clang-tidy-14 clang-format-14 doxygen)
      newest=(clang-22 libc++-22-dev)  # for the public headers, each alone
      shift ;;
  esac
done

fail() { echo "setup: $*" >&2; exit 1; }

# missing_of PACKAGE...: those that are not installed.
missing_of() {
  for p in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || echo "$p"
  done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif [ -t 0 ]; then sudo "$@"
  else sudo -n "$@"  # nobody is there to type a password
  fi
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

# provide PACKAGE...: installs those that are missing; what apt says is in $log. Package lists may be absent or out of
# date: they are refreshed only when the first try fails.
provide() {
  local missing
  mapfile -t missing < <(missing_of "$@")
  [ "${#missing[@]}" -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    echo "run me as root, or install sudo" >"$log"
    return 1
  fi
  echo "setup: installing ${missing[*]}"
  apt_install "${missing[@]}" >"$log" 2>&1 && return
  as_root apt-get update -qq -o DPkg::Lock::Timeout=300 </dev/null >"$log" 2>&1 || return
  apt_install "${missing[@]}" >"$log" 2>&1
}

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
  log=$(mktemp)
  trap 'rm -f "$log"' EXIT
  provide "${packages[@]}" ||
    { tail -n 20 "$log" >&2; fail "these packages are missing: $(missing_of "${packages[@]}" | xargs)"; }
  provide "${tools[@]}" ||
    echo "setup: no $(missing_of "${tools[@]}" | xargs): $(tail -n 1 "$log"); checks that need them are skipped" >&2
  provide "${newest[@]}" ||
    echo "setup: no $(missing_of "${newest[@]}" | xargs): the public headers are compiled with an older compiler" >&2
else
  echo "setup: no apt here; going on with what is installed (needed: ${packages[*]})" >&2
fi

if $browser && [ ! -d tests/view/node_modules ]; then
  npm --prefix tests/view ci --silent || echo "setup: npm could not install; the browser test is skipped" >&2
fi

# A build tree that exists keeps its generator.
build=build/$preset
generator=()
[ -e $build/CMakeCache.txt ] || generator=(-G Ninja)
cmake -S . -B $build "${generator[@]}" --log-level=WARNING -DCMAKE_BUILD_TYPE=Release "${options[@]}" >/dev/null

# How much there is to do. A source takes some four seconds of one processor, less with a warm compiler cache.
if [ -e $build/build.ninja ]; then
  sources=$(ninja -C $build -n -v ${1:+"$@"} | grep -c ' -c ' || true)
  [ "$sources" = 0 ] ||
    echo "setup: compiling $sources sources on $(nproc) processors: about $((sources * 4 / $(nproc) / 60 + 1)) minutes, less with a compiler cache"
fi
cmake --build $build --parallel "$(nproc)" ${1:+--target "$@"}
