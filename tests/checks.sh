#!/usr/bin/env bash
# The checks beside the tests, by name: tests/checks.sh [--quick] NAME... (or `all`). Each builds in a folder of build/.
#   format        clang-format, nothing is changed
#   asan          all tests but the long ones with AddressSanitizer and UndefinedBehaviorSanitizer, built by clang with
#                 warnings as errors; --quick: the tests of what reads bytes and indexes memory
#   tsan          servo, shared memory, device, recorder, view and helper threads with ThreadSanitizer
#   rtsan         servo and device with RealtimeSanitizer (clang 20 or newer)
#   headers       every public header compiles alone with the newest clang and the newest standard library that are here
#   clang         library, programs and tests with clang, warnings as errors (nothing is optimized)
#   tidy          clang-tidy with the list of .clang-tidy, over src/ and apps/
#   determinism   recordings of runs in virtual time: of builds with -O2 and -O3, idle and busy, the same bytes
#   docs          every public name has a docstring (doxygen), links of the documents
#   fuzz          every fuzz target for 20 seconds; --quick: 3
# A check whose tool is not installed is skipped: it says so, and the exit code at the end is 77. The tools (Debian 12)
# are those of `.ci/setup.sh --checks`, clang-22 libclang-rt-22-dev for rtsan, clang-22 libc++-22-dev for headers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=$(nproc)
generator=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi
fail() { echo "checks: $*" >&2; exit 1; }
configure() { cmake --log-level=WARNING "$@" >/dev/null; }
new_tree() { if [ -e "$1/CMakeCache.txt" ]; then echo; else echo "${generator[@]}"; fi; }
# needs PACKAGE COMMAND...: puts the first of the commands that is there into $tool; false, with the reason in $skipped,
# when none is.
needs() {
  local package=$1
  shift
  for tool in "$@"; do
    if command -v "$tool" >/dev/null; then return; fi
  done
  skipped="it needs $package"
  return 1
}
# The same for clang with its run-time libraries.
needs_clang() {
  needs clang-14 clang-14 clang || return
  runs_here "${tool/clang/clang++}" -fsanitize=address,undefined && return
  skipped="it needs libclang-rt-14-dev, and a machine where programs with these sanitizers run"
  return 1
}
# runs_here COMPILER FLAG...: whether an empty program built so runs. In some containers sanitizers do not.
runs_here() {
  local folder ok=0
  folder=$(mktemp -d)
  echo 'int main() {}' >"$folder/empty.cpp"
  { "$@" "$folder/empty.cpp" -o "$folder/empty" && "$folder/empty"; } 2>/dev/null || ok=1
  rm -r "$folder"
  return $ok
}
# own_files SUFFIX... : tracked and new sources of this project.
own_files() {
  local patterns=() suffix
  for suffix in "$@"; do patterns+=("*.$suffix"); done
  git ls-files --cached --others --exclude-standard -- "${patterns[@]}" | grep -E '^(include|src|apps|tests)/'
}

check_format() {
  needs clang-format-14 clang-format-14 || return 0  # others format otherwise
  own_files cpp hpp h c | xargs "$tool" --dry-run --Werror
}

# What reads files, walks over meshes by index, or shares memory; the fuzz targets of the same tree do the rest.
asan_quick=(core mesh gltf 3mf flat_files assembly isolated_load step device record recording patch feature servo scene_file)
check_asan() {
  local select=(--label-exclude '^(nightly|long|browser)$') targets=()
  needs_clang || return 0
  if $quick; then
    select+=(-R "^($(IFS='|'; echo "${asan_quick[*]}"))\$")
    targets=(--target "${asan_quick[@]/#/test_}")
  fi
  # The tree of the fuzz targets: both want the same library.
  # shellcheck disable=SC2046
  CC=$tool CXX=${tool/clang/clang++} configure --preset fuzz $(new_tree build/fuzz)
  cmake --build --preset fuzz --parallel "$jobs" "${targets[@]}"
  ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 \
    LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0 \
    ctest --test-dir build/fuzz --parallel "$jobs" --output-on-failure "${select[@]}"
}

check_tsan() {
  local tests=(servo device record view change sweep_helpers helper_threads)
  if ! runs_here "${CXX:-c++}" -fsanitize=thread; then
    skipped="programs with ThreadSanitizer do not run here"
    return
  fi
  # shellcheck disable=SC2046
  configure -S . -B build/tsan $(new_tree build/tsan) -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG="-fsanitize=thread -O1 -g1" -DCMAKE_C_FLAGS_DEBUG="-fsanitize=thread -O1 -g1"
  cmake --build build/tsan --parallel "$jobs" --target "${tests[@]/#/test_}"
  TSAN_OPTIONS=halt_on_error=1 ctest --test-dir build/tsan -R "^($(IFS='|'; echo "${tests[*]}"))\$" --output-on-failure
}

# The newest clang from a version on, in $tool.
newest_clang() {
  # shellcheck disable=SC2046
  needs "clang $1 or newer ($2)" $(seq -f 'clang-%g' 30 -1 "$1")
}

check_rtsan() {
  newest_clang 20 "clang-22 libclang-rt-22-dev" || return 0
  # shellcheck disable=SC2046
  CC=$tool CXX=${tool/clang/clang++} configure -S . -B build/rtsan $(new_tree build/rtsan) -DTEGOTAE_STEP=OFF -DTEGOTAE_WARNINGS_AS_ERRORS=OFF \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-fsanitize=realtime -O1 -g1"
  cmake --build build/rtsan --parallel "$jobs" --target test_servo test_device
  build/rtsan/bin/test_device
  build/rtsan/bin/test_servo '~*system call*'
  # That one makes the servo call the system on purpose; the sanitizer must see it.
  build/rtsan/bin/test_servo '*system call*' >build/rtsan/caught 2>&1 || true
  grep -q 'RealtimeSanitizer: unsafe-library-call' build/rtsan/caught || fail "the sanitizer saw nothing"
}

# A newer standard library has fewer of its headers along; clang's own has the fewest.
check_headers() {
  local eigen flags=(-fsyntax-only -Wall -Wextra -Werror -Iinclude)
  newest_clang 14 "clang-22 libc++-22-dev" || return 0
  ! echo '#include <vector>' | "$tool" -xc++ -stdlib=libc++ -fsyntax-only - 2>/dev/null || flags+=(-stdlib=libc++)
  echo "with $("$tool" --version | head -n 1) ${flags[*]}"
  eigen=$(pkg-config --cflags-only-I eigen3 | xargs)
  flags+=("${eigen/-I/-isystem}" -xc++)
  mkdir -p build
  (cd include && find tegotae -name '*.h*' -printf '#include "%p"\n') | sort >build/headers.txt
  # shellcheck disable=SC2016
  tr '\n' '\0' <build/headers.txt |
    xargs -0 -P "$jobs" -I{} sh -c 'header=$1; shift; echo "$header" | "$@" - || { echo "alone: $header" >&2; exit 1; }' \
      sh {} "$tool" -std=c++17 "${flags[@]}"
  "$tool" -std=c++2b "${flags[@]}" build/headers.txt
}

# In $tool: clang. Each source for itself: each must have what it needs.
configure_clang() {
  # shellcheck disable=SC2046
  CC=$tool CXX=${tool/clang/clang++} configure -S . -B build/clang $(new_tree build/clang) -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DTEGOTAE_UNITY=OFF
}

check_clang() {
  needs clang-14 clang-14 clang || return 0
  configure_clang
  cmake --build build/clang --parallel "$jobs"
}

check_tidy() {
  needs clang-14 clang-14 clang || return 0
  configure_clang
  needs clang-tidy-14 clang-tidy-14 || return 0  # others warn of more
  own_files cpp | grep -E '^(src|apps)/' | xargs -P "$jobs" -n 4 "$tool" --quiet -p build/clang
}

# Twice of each build, the second time with the machine busy.
check_determinism() {
  local ratio resolver build run busy sums=()
  # shellcheck disable=SC2046
  configure --preset release $(new_tree build/release)
  cmake --build --preset release --parallel "$jobs" --target peg_in_hole
  # shellcheck disable=SC2046
  configure -S . -B build/o2 $(new_tree build/o2) -DCMAKE_BUILD_TYPE=Release -DTEGOTAE_BUILD_TESTS=OFF \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG"
  cmake --build build/o2 --parallel "$jobs" --target peg_in_hole
  for ratio in 0.94 0.99; do
    for resolver in qp lp; do
      sums=()
      for build in release o2; do
        for run in alone busy; do
          busy=()
          [ "$run" = alone ] || for _ in $(seq "$jobs"); do timeout 300 sha256sum /dev/zero & busy+=($!); done
          build/$build/bin/peg_in_hole --ratio $ratio --resolver $resolver --fast --record build/o2/run.csv >/dev/null
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
  python3 tests/docs/check_links.py
  needs doxygen doxygen || return 0
  bash tests/docs/doxygen.sh build/doxygen
}

check_fuzz() {
  needs_clang || return 0
  bash tests/fuzz/run.sh "$(if $quick; then echo 3; else echo 20; fi)"
}

quick=false
if [ "${1:-}" = --quick ]; then
  quick=true
  shift
fi
[ $# -gt 0 ] || fail "name a check: format asan tsan rtsan headers clang tidy determinism docs fuzz, or all"
code=0
[ "$*" != all ] || set -- format docs headers tsan rtsan determinism clang tidy asan fuzz
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
