#!/usr/bin/env bash
# Fuzzes one target after the other: tests/fuzz/run.sh SECONDS [TARGET...] (all targets without names).
# Needs clang with libFuzzer (Debian: clang-14 libclang-rt-14-dev; other versions: TEGOTAE_CLANG=-NN). Builds into
# build/fuzz; corpora, what was found and logs are in build/fuzz/run/TARGET. Exit code 1 when something was found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:?usage: tests/fuzz/run.sh SECONDS [TARGET...]}
shift
targets=("$@")
[ "${#targets[@]}" -gt 0 ] || targets=(stl obj ply off gltf glb 3mf step scene script recording shared_memory page http tries)
parts=${TEGOTAE_PARTS_DIR:-../shared/parts}

clang=${TEGOTAE_CLANG:--14}
CC=clang$clang CXX=clang++$clang cmake --preset fuzz --log-level=WARNING >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)" --target "${targets[@]/#/fuzz_}"

# A mistake is a crash, as the fuzzer counts only those.
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
found=0
for target in "${targets[@]}"; do
  dir=build/fuzz/run/$target
  mkdir -p "$dir/corpus" "$dir/found" "$dir/seeds"
  build/fuzz/bin/fuzz_"$target" --write-seeds "$dir/seeds"
  # Real files of the format, where they are; large ones only slow the fuzzer down.
  if [ -d "$parts" ]; then
    find -L "$(realpath "$parts")" -iname "*.$target" -size -40k -exec ln -sf -t "$dir/seeds" {} +
  fi
  known=tests/fuzz/findings/$target
  [ -d "$known" ] || known=
  # assimp leaks when it refuses a file: one look at the end of each process, with tests/lsan.supp, has to do.
  leaks=
  [[ " stl obj ply off gltf glb 3mf " != *" $target "* ]] || leaks=-detect_leaks=0
  before=$(find "$dir/found" -type f | wc -l)
  # Each job is a process of its own, so that a crash inside assimp does not end the run.
  nice -n 10 build/fuzz/bin/fuzz_"$target" -fork=1 -ignore_crashes=1 -ignore_ooms=1 -ignore_timeouts=1 \
    $leaks -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=16384 \
    -artifact_prefix="$dir/found/" "$dir/corpus" "$dir/seeds" $known >"$dir/log" 2>&1 || true
  after=$(find "$dir/found" -type f | wc -l)
  echo "$target: $(grep -E '^#[0-9]+: cov' "$dir/log" | tail -n 1)"
  [ "$after" = "$before" ] || { echo "$target: $((after - before)) new files in $dir/found"; found=1; }
done
exit $found
