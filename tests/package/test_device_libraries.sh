#!/usr/bin/env bash
# What a device's program loads, since its pages are locked into memory: test_device_libraries.sh TEGOTAE_DEVICE
# TEGOTAE READELF.
# No library of meshes, files or web servers. That the check sees such libraries is tried on the program that runs scenes.
set -euo pipefail
device=${1:?usage: test_device_libraries.sh TEGOTAE_DEVICE TEGOTAE READELF}
runner=${2:?usage: test_device_libraries.sh TEGOTAE_DEVICE TEGOTAE READELF}
readelf=${3:?usage: test_device_libraries.sh TEGOTAE_DEVICE TEGOTAE READELF}
foreign='assimp|fcl|ccd|octomap|TK[A-Z]|civetweb|pugixml|zstd|libz[.]|minizip|draco|meshopt|toml'

needed() { "$readelf" -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'; }

needed "$runner" | grep -qE "$foreign" || { echo "test_device_libraries: the check sees nothing in $runner" >&2; exit 1; }
needed "$device" | grep -q libc.so || { echo "test_device_libraries: nothing was read of $device" >&2; exit 1; }
if needed "$device" | grep -E "$foreign"; then
  echo "test_device_libraries: $device loads the above" >&2
  exit 1
fi
echo "loads: $(needed "$device" | tr '\n' ' ')"
