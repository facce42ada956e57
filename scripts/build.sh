#!/usr/bin/env bash
# Configures and builds a preset of CMakePresets.json in build/<preset>.
#   scripts/build.sh [preset, default release [target, default all]]
set -euo pipefail
source "$(dirname "$0")/environment.sh"

preset=${1:-release}
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset"
cmake --build --preset "$preset" --target "${2:-all}"
