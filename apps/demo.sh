#!/usr/bin/env bash
# The demo: installs what is missing, builds, and carries a peg into its hole in real time.
# `bash apps/demo.sh` shows the fits 0.94 and 0.99; arguments go to the program (see peg_in_hole --help).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash .ci/setup.sh peg_in_hole tegotae_cli
if [ $# -gt 0 ]; then
  exec build/release/bin/peg_in_hole "$@"
fi
build/release/bin/peg_in_hole --ratio 0.94
echo
build/release/bin/peg_in_hole --ratio 0.99
