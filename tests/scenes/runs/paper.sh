#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The scenes of the paper's experiments: their first steps are the same on 1 and 3 ranks (can and wing: on 7 too), to the bit, and the ledger closes.
source "$(dirname "$0")/common.sh"
# Ranks to compare with one, scene, settings.
first_steps() {
  local others=$1 scene=$2 name=${2//\//-}
  shift 2
  for ranks in 1 $others; do
    run $ranks "$scenes/$scene.yaml" $name$ranks --set output.frames.every="1 s" --set output.checkpoint.every="1 s" "$@"
    same_state ${name}1 $name$ranks
    cmp ${name}1/history.csv $name$ranks/history.csv
  done
  awk -F, -v name="$name" '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { error = $column["energy_error"]; if (error > worst) worst = error; rows++ }
    END { printf "%s: greatest ledger error %.1e in %d rows\n", name, worst, rows; exit !(rows > 5 && worst <= 1e-11) }' ${name}1/history.csv
}
first_steps "3 7" can-crush/scene --set end_time="50 us" --set output.history.every="10 steps"
first_steps 3 penetrator/scene --set end_time="8 us" --set output.history.every="2 steps"
first_steps 3 penetrator/thermal --set end_time="5 us" --set output.history.every="1 step"
first_steps "3 7" wing-and-pole/scene --set end_time="60 us" --set output.history.every="2 steps" --set parameters.spacing="40 mm"
first_steps 3 foam-crush/scene --set end_time="1 us" --set output.history.every="2 steps" --set parameters.cells=2 --set parameters.elements=8
first_steps 3 rod-through-plate/scene --set end_time="20 us" --set output.history.every="2 steps" --set parameters.layers=6
# One parameter refines the can: each doubling has twice as many elements.
for doublings in 0 1 2 3 4 5; do
  "$tenon" check "$scenes/can-crush/scene.yaml" --set parameters.doublings=$doublings >check.txt
  grep -q "mesh can: .* $((1800 * 2 ** doublings)) elements" check.txt && grep -q "mesh wall: .* $((75 * 2 ** doublings)) elements" check.txt || { cat check.txt; exit 1; }
done
echo "1 passed, 0 failed"
