#!/usr/bin/env bash
# The demo: installs what is missing, builds, and carries a peg into its hole in real time: the fits 0.94 and 0.99.
# `bash apps/demo.sh` compiles what that needs and no more, in a build folder of its own. With arguments it builds and runs
# the program peg_in_hole, which also records and serves a page (see peg_in_hole --help): `bash apps/demo.sh --view`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [ $# -gt 0 ]; then
  bash .ci/setup.sh peg_in_hole
  exec build/release/bin/peg_in_hole "$@"
fi
bash .ci/setup.sh --demo
exec build/demo/bin/demo
