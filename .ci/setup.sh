#!/usr/bin/env bash
# Installs what is missing (Debian 12, apt), configures and builds: setup.sh [--browser] [TARGET...] (everything without
# targets). --browser adds what the tests need that are not daily: a browser, doxygen.
# Shared by apps/demo.sh and tests/run.sh; a second call only builds what changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# pkg-config, dpkg-dev, file: the tests of the package.
packages=(g++ cmake ninja-build libeigen3-dev libfcl-dev libccd-dev libassimp-dev zlib1g-dev
          libzstd-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libcivetweb-dev catch2 python3-venv
          libspnav-dev libsdl2-dev libocct-data-exchange-dev pkg-config dpkg-dev file)

browser=false
if [ "${1:-}" = --browser ]; then
  browser=true
  shift
  packages+=(doxygen)
  # By command: Node may come from elsewhere, with npm in it.
  for command in node:nodejs npm:npm chromium:chromium; do
    command -v "${command%:*}" >/dev/null || packages+=("${command#*:}")
  done
fi

fail() { echo "setup: $*" >&2; exit 1; }

missing_packages() {
  for p in "${packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || echo "$p"
  done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif [ -t 0 ]; then sudo "$@"
  else sudo -n "$@"  # nobody is there to type a password
  fi
}

install_packages() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
  mapfile -t missing < <(missing_packages)
  if [ "${#missing[@]}" -gt 0 ]; then
    [ "$(id -u)" = 0 ] || command -v sudo >/dev/null ||
      fail "run me as root, or install sudo: these packages are missing: ${missing[*]}"
    echo "setup: installing ${missing[*]}"
    log=$(mktemp)
    trap 'rm -f "$log"' EXIT
    # Package lists may be absent or out of date: refresh them only when the first try fails.
    if ! install_packages "${missing[@]}" >"$log" 2>&1; then
      as_root apt-get update -qq -o DPkg::Lock::Timeout=300 </dev/null || fail "apt-get update failed"
      install_packages "${missing[@]}" >"$log" 2>&1 ||
        { tail -n 20 "$log" >&2; fail "apt could not install ${missing[*]}"; }
    fi
  fi
else
  echo "setup: no apt here; going on with what is installed (needed: ${packages[*]})" >&2
fi

if $browser && [ ! -d tests/view/node_modules ]; then
  npm --prefix tests/view ci --silent || echo "setup: npm could not install; the browser test is skipped" >&2
fi

# A build tree that exists keeps its generator.
generator=()
[ -e build/release/CMakeCache.txt ] || generator=(-G Ninja)
cmake --preset release "${generator[@]}" --log-level=WARNING -DTEGOTAE_BUILD_APPS=ON -DTEGOTAE_BUILD_TESTS=ON >/dev/null
cmake --build --preset release --parallel "$(nproc)" ${1:+--target "$@"}
