#!/usr/bin/env bash
# One line: the system with its suite, machine, compiler, OpenCASCADE. What passes says with it where it passed.
set -euo pipefail
occt=$(dpkg-query -W -f='${Version}' libocct-data-exchange-dev 2>/dev/null) || occt=none
echo "$(. /etc/os-release && echo "$PRETTY_NAME"), $(uname -m), $(c++ --version | head -n 1), OpenCASCADE $occt"
