# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the run tests: where things are, and short names for what every test does.
set -euo pipefail
tenon=$1
scenes=$2
work=$PWD/runs/$(basename "$0" .sh)
rm -rf "$work"
mkdir -p "$work"
cd "$work"
main_job=$scenes/hot-taylor-bar/scene.yaml

# Ranks, scene, folder, further arguments; quiet unless it fails.
run() {
  local ranks=$1 scene=$2 folder=$3
  shift 3
  mpirun --oversubscribe -n "$ranks" "$tenon" run "$scene" -o "$folder" "$@" >"$folder.log" 2>&1 || { tail -40 "$folder.log"; return 1; }
}

# Two final states must hold the same bits.
same_state() {
  h5diff "$1/final.h5" "$2/final.h5" >diff.txt 2>&1 && [ ! -s diff.txt ] || { echo "$1 and $2 differ:"; head -5 diff.txt; exit 1; }
}
