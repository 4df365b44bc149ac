#!/usr/bin/env bash
# Every public name has a docstring: docs/Doxyfile over include/, warnings are errors. doxygen.sh FOLDER: where the HTML
# goes. Says so and ends with 77 where doxygen is not installed.
set -euo pipefail
out=$(realpath -m "${1:?usage: doxygen.sh FOLDER}")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
command -v doxygen >/dev/null || { echo "SKIPPED: doxygen is not installed"; exit 77; }

run() { (cat docs/Doxyfile; printf '%s\n' "$@") | doxygen -; }
mkdir -p "$out"
run "OUTPUT_DIRECTORY = $out"

# That it can fail: a header with an undocumented function must be refused.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp include/tegotae/core/export.hpp "$work"
printf 'namespace tegotae {\nint undocumented();\n}\n' >"$work/bad.hpp"
if run "INPUT = $work" "OUTPUT_DIRECTORY = $work" "GENERATE_HTML = NO" 2>/dev/null; then
  echo "doxygen.sh: an undocumented name was taken" >&2
  exit 1
fi
