#!/usr/bin/env bash
# Pictures of the reports for docs/experiments.md: plots.sh REPORTS DOCS_FOLDER, after `tegotae experiment all --out
# REPORTS`. Needs chromium (apt-get install chromium).
set -euo pipefail
reports=${1:?folder of the reports} to=${2:?folder for the pictures}
mkdir -p "$to"
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
picture() {  # NAME HEIGHT
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --force-device-scale-factor=0.8 --blink-settings=preferredColorScheme=1 \
    --user-data-dir="$profile" --window-size="1040,$2" --virtual-time-budget=3000 \
    --screenshot="$to/$1.png" "file://$(realpath "$reports/$1/report.html")" 2>/dev/null
  echo "$to/$1.png"
}
picture wall 2100
picture insertion 1480
picture task-time 1250
picture ladder 1340
picture hold 1130
picture widening 1640
picture wrench 3480
picture friction 3200
picture friction-tasks 1700
