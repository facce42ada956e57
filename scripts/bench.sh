#!/usr/bin/env bash
# Builds and runs a benchmark, one core; its results go to FILE as a list of JSON objects.
#   scripts/bench.sh NAME [--quick] --json FILE      NAME: a folder of benchmarks, e.g. detection
set -euo pipefail
file=
arguments=("${@:2}")
for ((i = 0; i < ${#arguments[@]}; ++i)); do # FILE is meant from where the command was given
  if [ "${arguments[i]}" = --json ] && [ $((i + 1)) -lt ${#arguments[@]} ]; then
    file=${arguments[i + 1]}
    arguments[i + 1]=$(realpath "$file")
  fi
done
source "$(dirname "$0")/environment.sh"

name=${1:-}
if [ ! -f "benchmarks/$name/run.py" ] || [ -z "$name" ] || [ -z "$file" ]; then
  echo "usage: scripts/bench.sh NAME [--quick] --json FILE; there are: $(cd benchmarks && echo */)" >&2
  exit 2
fi
bash scripts/install-deps.sh --benchmarks
bash scripts/build.sh bench "bench_$name"
python3 "benchmarks/$name/run.py" "build/bench/benchmarks/bench_$name" "${arguments[@]}"
