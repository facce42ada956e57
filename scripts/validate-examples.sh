#!/usr/bin/env bash
# Runs all examples: convergence, Newton iterations, and figures against references (about 10 minutes).
#   scripts/validate-examples.sh [name ...]    only the examples of these names
#   AMONTONS=path/to/amontons uses that program instead of building one.
set -euo pipefail
source "$(dirname "$0")/environment.sh"

export PYTHONDONTWRITEBYTECODE=1
[ -n "${AMONTONS:-}" ] || bash scripts/build.sh release
exec python3 scripts/validate_examples.py "${AMONTONS:-build/release/app/amontons}" "$@"
