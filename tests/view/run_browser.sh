#!/usr/bin/env bash
# Runs the browser test, or says why not (exit code 77).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

skip() { echo "SKIPPED: $*"; exit 77; }
command -v node >/dev/null || skip "no Node here"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "no Chromium here (CHROMIUM says where it is)"
[ -d node_modules/playwright-core ] || skip "run npm ci in tests/view first"
exec node browser.mjs "$@"
