#!/usr/bin/env bash
# Device, application and a watching page together, with random kills: tests/soak.sh MINUTES [SEED]. See docs/soak.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash .ci/setup.sh tegotae_cli tegotae_device soak_judge
exec python3 tests/soak/soak.py "$@"
