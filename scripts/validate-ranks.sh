#!/usr/bin/env bash
# Solves every example (long ones shortened, increments fixed) on 1, 2, 3 and 4 processes: forces, pressures, radii of contact
# and of stick must agree to 1e-8, statuses be the same, and with the direct solver Newton's iterations too (the others solve
# loosely at first, and how depends on the subdomains). Prints a table; exit code 1 on a difference.
#   scripts/validate-ranks.sh [EXAMPLE ...]    EXAMPLE as in punch/punch
#   AMONTONS=path/to/amontons uses that program instead of building one.
set -euo pipefail
source "$(dirname "$0")/environment.sh"

export PYTHONDONTWRITEBYTECODE=1 OMPI_MCA_mpi_yield_when_idle=1
[ -n "${AMONTONS:-}" ] || bash scripts/build.sh release amontons_app
exec python3 scripts/validate_ranks.py "${AMONTONS:-build/release/app/amontons}" "$@"
