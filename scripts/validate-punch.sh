#!/usr/bin/env bash
# Stick radius, load and slip under the rigid punch against exact values (about 4 minutes).
#   scripts/validate-punch.sh [n ...]    meshes of n cells under the punch, default 100 200 400
#   AMONTONS=path/to/amontons uses that program instead of building one.
set -euo pipefail
source "$(dirname "$0")/environment.sh"

export PYTHONDONTWRITEBYTECODE=1
[ -n "${AMONTONS:-}" ] || bash scripts/build.sh release
exec python3 scripts/validate_punch.py "${AMONTONS:-build/release/app/amontons}" "$@"
