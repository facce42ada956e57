#!/usr/bin/env bash
# Formats every C++ source with clang-format 14; with --check changes nothing and fails where something would change.
set -euo pipefail
source "$(dirname "$0")/environment.sh"

how=(-i)
[ "${1:-}" = --check ] && how=(--dry-run --Werror)
find src app tests benchmarks -name '*.h' -print0 -o -name '*.cc' -print0 |
  xargs -0 --max-procs=2 --max-args=20 clang-format-14 "${how[@]}"
