#!/usr/bin/env bash
# Installs the dependencies, builds and runs all tests.   scripts/test.sh [arguments for ctest, e.g. -L core]
set -euo pipefail
source "$(dirname "$0")/environment.sh"

bash scripts/install-deps.sh
bash scripts/build.sh release
ctest --preset release "$@"
