#!/usr/bin/env bash
# tests/run.sh repeats tests labeled `realtime` alone, counts them, and fails when a test does: test_run_script.sh RUN.
# Runs it in a folder where set-up and ctest are stubs; the one of ctest writes down how it was called.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "run_script: $*" >&2; exit 1; }

mkdir -p "$work/tests" "$work/.ci" "$work/bin" "$work/build/python"
cp "$1" "$work/tests/run.sh"
touch "$work/tests/requirements.txt" "$work/build/python/requirements.txt"
echo true >"$work/.ci/setup.sh"
echo 'echo "a system"' >"$work/.ci/system.sh"
cat >"$work/bin/ctest" <<'STUB'
#!/usr/bin/env bash
echo "$*" >>"$CALLS"
case "$*" in
  *--repeat*) printf '      Start  7: servo\n      Start  8: change\n      Start  7: servo\n'; exit "$REALTIME" ;;
  *) exit "$OTHERS" ;;
esac
STUB
chmod +x "$work/bin/ctest"

# run OTHERS REALTIME ARGUMENT...: the exit codes of the two calls; in $calls how ctest was called, in $code what run.sh said.
run() {
  code=0
  : >"$work/calls"
  CALLS=$work/calls OTHERS=$1 REALTIME=$2 PATH=$work/bin:$PATH bash "$work/tests/run.sh" "${@:3}" >"$work/said" || code=$?
  mapfile -t calls <"$work/calls"
}

run 0 0 --repeat 3
[ "$code" = 0 ] || fail "exit code $code where all passed"
[ "${#calls[@]}" = 2 ] || fail "${#calls[@]} calls of ctest"
case ${calls[0]} in *--repeat*) fail "all tests are repeated: ${calls[0]}" ;; esac
[[ ${calls[0]} == *"--label-exclude ^(nightly|realtime)$"* ]] || fail "the first call: ${calls[0]}"
[[ ${calls[1]} == *"--label-regex ^realtime$"*"--repeat until-pass:3"* ]] || fail "the second call: ${calls[1]}"
grep -qx 'tests/run.sh: 1 of 2 realtime tests were repeated: servo' "$work/said" || fail "said: $(cat "$work/said")"

run 0 0
[[ ${calls[1]} == *"--repeat until-pass:1"* ]] || fail "unless asked, nothing is repeated: ${calls[1]}"
for codes in "8 0" "0 8"; do
  # shellcheck disable=SC2086
  run $codes
  [ "$code" = 8 ] || fail "exit code $code where a test failed ($codes)"
  ! grep -q 'all passed' "$work/said" || fail "all passed, it says, where a test failed ($codes)"
done
