#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests: `bash tests/run.sh`. With --quick the tests labeled `long` and
# `browser` are left out; other arguments go to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

select=()
setup=(--browser)
if [ "${1:-}" = --quick ]; then
  select=(--label-exclude '^(long|browser)$')
  setup=()
  shift
fi

bash .ci/setup.sh "${setup[@]}"

# Independent readers, for tests only.
python=build/python
if ! cmp -s tests/requirements.txt $python/requirements.txt; then
  if python3 -m venv $python && $python/bin/pip install -q --disable-pip-version-check -r tests/requirements.txt; then
    cp tests/requirements.txt $python/
  else
    echo "tests/run.sh: no Python packages; the tests that need them are skipped" >&2
  fi
fi

exec ctest --preset release --parallel "$(nproc)" "${select[@]}" "$@"
