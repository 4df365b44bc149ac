#!/usr/bin/env bash
# Every public header compiles alone, with the newest g++ that is here (or CXX): public_headers.sh EIGEN_FOLDER
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

compiler=${CXX:-g++}
if [ -z "${CXX:-}" ]; then
  for n in $(seq 40 -1 7); do
    if command -v "g++-$n" >/dev/null; then compiler=g++-$n; break; fi
  done
fi
"$compiler" --version | head -n 1

check_header() {
  local compiler=$1 eigen=$2 header=$3 language=(-x c++ -std=c++17)
  if [[ $header == *.h ]]; then language=(-x c -std=c11); fi
  echo "#include \"$header\"" |
    "$compiler" "${language[@]}" -fsyntax-only -Wall -Wextra -Werror -Iinclude -isystem "$eigen" - ||
    { echo "public_headers: $header does not compile alone" >&2; return 1; }
}
export -f check_header
(cd include && find tegotae -name '*.h' -o -name '*.hpp' | sort) |
  xargs -P "$(nproc)" -I{} bash -c 'check_header "$@"' _ "$compiler" "$1" {}
