#!/usr/bin/env bash
# The checks beside the tests, by name: tests/checks.sh NAME... (or `all`). Each builds in build/NAME.
#   format        clang-format, nothing is changed
#   asan          all tests but the long ones with AddressSanitizer and UndefinedBehaviorSanitizer
#   tsan          servo, shared memory, device, recorder and view with ThreadSanitizer
#   rtsan         servo and device with RealtimeSanitizer (clang 20 or newer; without, exit code 77 at the end)
#   clang         library, programs and tests with clang, warnings as errors (nothing is optimized)
#   tidy          clang-tidy with the list of .clang-tidy, over src/ and apps/
#   determinism   recordings of runs in virtual time: of builds with -O2 and -O3, idle and busy, the same bytes
#   docs          every public name has a docstring (doxygen), links of the documents
#   fuzz          every fuzz target for TEGOTAE_FUZZ_SECONDS (20) seconds
# Packages beside those of .ci/setup.sh (Debian 12): clang-14 libclang-rt-14-dev clang-tidy-14 clang-format-14
# clang-22 libclang-rt-22-dev doxygen.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=$(nproc)
generator=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi
fail() { echo "checks: $*" >&2; exit 1; }
configure() { cmake --log-level=WARNING "$@" >/dev/null; }
new_tree() { if [ -e "$1/CMakeCache.txt" ]; then echo; else echo "${generator[@]}"; fi; }
first_of() {
  local name
  for name in "$@"; do
    if command -v "$name" >/dev/null; then echo "$name"; return; fi
  done
  fail "none of these is installed: $*"
}
# own_files SUFFIX... : tracked and new sources of this project.
own_files() {
  local patterns=() suffix
  for suffix in "$@"; do patterns+=("*.$suffix"); done
  git ls-files --cached --others --exclude-standard -- "${patterns[@]}" | grep -E '^(include|src|apps|tests)/'
}

check_format() {
  own_files cpp hpp h c | xargs "$(first_of clang-format-14 clang-format)" --dry-run --Werror
}

check_asan() {
  # shellcheck disable=SC2046
  configure --preset debug $(new_tree build/debug)
  cmake --build --preset debug --parallel "$jobs"
  ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 \
    ctest --preset debug --parallel "$jobs" --label-exclude '^long$' "$@"
}

check_tsan() {
  local tests=(servo device record view change)
  # shellcheck disable=SC2046
  configure -S . -B build/tsan $(new_tree build/tsan) -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG="-fsanitize=thread -O1 -g1" -DCMAKE_C_FLAGS_DEBUG="-fsanitize=thread -O1 -g1"
  cmake --build build/tsan --parallel "$jobs" --target "${tests[@]/#/test_}"
  TSAN_OPTIONS=halt_on_error=1 ctest --test-dir build/tsan -R "^($(IFS='|'; echo "${tests[*]}"))\$" --output-on-failure
}

check_rtsan() {
  local clang="" n
  for n in $(seq 30 -1 20); do
    if command -v "clang++-$n" >/dev/null; then clang=clang-$n; break; fi
  done
  if [ -z "$clang" ]; then
    skipped="it needs clang 20 or newer with its runtime (clang-22 libclang-rt-22-dev)"
    return
  fi
  # shellcheck disable=SC2046
  CC=$clang CXX=${clang/clang/clang++} configure -S . -B build/rtsan $(new_tree build/rtsan) -DTEGOTAE_STEP=OFF -DTEGOTAE_WARNINGS_AS_ERRORS=OFF \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-fsanitize=realtime -O1 -g1"
  cmake --build build/rtsan --parallel "$jobs" --target test_servo test_device
  build/rtsan/bin/test_device
  build/rtsan/bin/test_servo '~*system call*'
  # That one makes the servo call the system on purpose; the sanitizer must see it.
  build/rtsan/bin/test_servo '*system call*' >build/rtsan/caught 2>&1 || true
  grep -q 'RealtimeSanitizer: unsafe-library-call' build/rtsan/caught || fail "the sanitizer saw nothing"
}

configure_clang() {
  local clang
  clang=$(first_of clang-14 clang)
  # shellcheck disable=SC2046
  CC=$clang CXX=${clang/clang/clang++} configure -S . -B build/clang $(new_tree build/clang) -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
}

check_clang() {
  configure_clang
  cmake --build build/clang --parallel "$jobs"
}

check_tidy() {
  configure_clang
  own_files cpp | grep -E '^(src|apps)/' | xargs -P "$jobs" -n 4 "$(first_of clang-tidy-14 clang-tidy)" --quiet -p build/clang
}

# Twice of each build, the second time with the machine busy.
check_determinism() {
  local ratio resolver build run busy sums=()
  # shellcheck disable=SC2046
  configure --preset release $(new_tree build/release)
  cmake --build --preset release --parallel "$jobs" --target tegotae_cli
  # shellcheck disable=SC2046
  configure -S . -B build/o2 $(new_tree build/o2) -DCMAKE_BUILD_TYPE=Release -DTEGOTAE_BUILD_TESTS=OFF \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG"
  cmake --build build/o2 --parallel "$jobs" --target tegotae_cli
  for ratio in 0.94 0.99; do
    for resolver in qp lp; do
      sums=()
      for build in release o2; do
        for run in alone busy; do
          busy=()
          [ "$run" = alone ] || for _ in $(seq "$jobs"); do timeout 300 sha256sum /dev/zero & busy+=($!); done
          build/$build/bin/tegotae run models/peg_in_hole_$ratio.toml --resolver $resolver --fast \
            --record build/o2/run.csv >/dev/null
          [ "$run" = alone ] || { kill "${busy[@]}"; wait "${busy[@]}" 2>/dev/null || true; }
          sums+=("$(sha256sum <build/o2/run.csv | cut -d ' ' -f 1)")
        done
      done
      echo "$ratio, $resolver: ${sums[0]}"
      [ "$(printf '%s\n' "${sums[@]}" | sort -u | wc -l)" = 1 ] ||
        fail "the recordings differ (-O3, -O3 busy, -O2, -O2 busy): ${sums[*]}"
    done
  done
}

check_docs() {
  command -v doxygen >/dev/null || fail "doxygen is not installed"
  bash tests/docs/doxygen.sh build/doxygen
  python3 tests/docs/check_links.py
}

check_fuzz() { bash tests/fuzz/run.sh "${TEGOTAE_FUZZ_SECONDS:-20}"; }

[ $# -gt 0 ] || fail "name a check: format asan tsan rtsan clang tidy determinism docs fuzz, or all"
code=0
[ "$*" != all ] || set -- format docs tsan rtsan determinism clang tidy asan fuzz
for name in "$@"; do
  declare -F "check_$name" >/dev/null || fail "unknown check $name"
  SECONDS=0
  skipped=""
  echo "checks: $name"
  "check_$name"  # not in a condition: that would turn errexit off in it
  if [ -n "$skipped" ]; then
    echo "checks: $name is skipped: $skipped" >&2
    code=77
  else
    echo "checks: $name is good ($SECONDS s)"
  fi
done
exit $code
