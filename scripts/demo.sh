#!/usr/bin/env bash
# Installs the dependencies, builds, presses a rigid punch into an elastic half-space with friction, and shows what came out.
set -euo pipefail
source "$(dirname "$0")/environment.sh"
export PYTHONDONTWRITEBYTECODE=1

bash scripts/install-deps.sh
bash scripts/build.sh release amontons_app

results=out/punch
build/release/app/amontons run examples/punch/punch.yaml --output "$results"
echo
python3 scripts/stick_radius.py "$results" 0.3 0.2 # Poisson's ratio and friction of the deck
echo "pictures, for ParaView: $results/solution.pvd and $results/contact_interface.pvd"
echo "numbers: $results/record.json and $results/contact_interface.csv (docs/outputs.md)"
