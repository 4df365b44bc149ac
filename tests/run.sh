#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests: `bash tests/run.sh`. With --quick the tests labeled `long` are
# left out; other arguments go to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

select=()
if [ "${1:-}" = --quick ]; then
  select=(--label-exclude '^long$')
  shift
fi

bash .ci/setup.sh
exec ctest --preset release --parallel "$(nproc)" "${select[@]}" "$@"
