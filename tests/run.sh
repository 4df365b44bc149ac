#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests:
# `bash tests/run.sh [--quick|--nightly] [--repeat N] [CTEST ARGUMENT...]`.
# Tests labeled `nightly` take minutes to hours each and run with --nightly only; with --quick the tests labeled `long` and
# `browser` are left out too. With --repeat a test labeled `realtime`, which looks at
# real processes and real time, is asked up to N times until it passes, and the end says which were; every other test is
# run once, for it can only fail for a reason.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

left_out=nightly
setup=(--browser)
repeat=1
while :; do
  case ${1:-} in
    --quick) left_out='nightly|long|browser'; setup=(); shift ;;
    --nightly) left_out=none; shift ;;
    --repeat) repeat=$2; shift 2 ;;
    *) break ;;
  esac
done

bash .ci/setup.sh "${setup[@]}"
system=$(bash .ci/system.sh)
echo "tests/run.sh: on $system"

# Independent readers, for tests only.
python=build/python
if ! cmp -s tests/requirements.txt $python/requirements.txt; then
  if python3 -m venv $python && $python/bin/pip install -q --disable-pip-version-check -r tests/requirements.txt; then
    cp tests/requirements.txt $python/
  else
    echo "tests/run.sh: no Python packages; the tests that need them are skipped" >&2
  fi
fi

code=0
# One more than there are processors: some tests wait for servers and downloads.
ctest --preset release --parallel $(($(nproc) + 1)) --label-exclude "^($left_out|realtime)\$" "$@" || code=$?
log=$(mktemp)
trap 'rm -f "$log"' EXIT
ctest --preset release --parallel "$(nproc)" --label-regex '^realtime$' --label-exclude "^($left_out)\$" \
  --repeat "until-pass:$repeat" "$@" | tee "$log" || code=$?
# A test that is asked again starts again.
again=$(sed -n 's/^ *Start *[0-9]*: //p' "$log" | sort | uniq -d | xargs)
echo "tests/run.sh: $(wc -w <<<"$again") of $(sed -n 's/^ *Start *[0-9]*: //p' "$log" | sort -u | wc -l)" \
  "realtime tests were repeated${again:+: $again}"
[ "$code" != 0 ] || echo "tests/run.sh: all passed on $system"
exit "$code"
