#!/usr/bin/env bash
# Holds the program against references and writes docs/verification.md (about 15 minutes on two cores).
#   scripts/verify.sh [CASE ...] [--fine: the finest meshes too, much longer | --coarse: those of the tests, writes no page]
#   AMONTONS=path/to/amontons uses that program instead of building one.
set -euo pipefail
source "$(dirname "$0")/environment.sh"

export PYTHONDONTWRITEBYTECODE=1
[ -n "${AMONTONS:-}" ] || bash scripts/build.sh release amontons_app
exec python3 verification/run.py "${AMONTONS:-build/release/app/amontons}" "$@"
