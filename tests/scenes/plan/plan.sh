#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# tenon plan --ranks on scenes with particles, shells and contact: every phase is there, decompositions and machines are told apart.
source "$(dirname "$0")/../runs/common.sh"
printf 'latency: 2 us\nbandwidth: 1e9\nslowness: 3\n' >machine.yaml
"$tenon" plan "$scenes/bird-strike/scene.yaml" --set meshes.bird.spacing="6 mm" --after 5 --trial 5 --ranks 1,3,64 --machine cluster,machine.yaml \
  --decomposition own,static --csv scaling.csv >plan.txt
for word in "measured per step of 5" "bird: forces" "bird: home" "sheet: halo" "contact: search" "64 ranks (static)" "speed-up" "machine.yaml"; do
  grep -q -- "$word" plan.txt || { echo "plan does not say '$word':"; cat plan.txt; exit 1; }
done
# Per machine, decomposition and number of ranks: the same phases.
awk -F, 'NR > 1 { phases[$1 "," $2 "," $3]++ } END { for (k in phases) { count++; if (phases[k] != phases["cluster,own,1"]) exit 1 } exit count != 12 }' scaling.csv \
  || { echo "scaling.csv:"; cat scaling.csv; exit 1; }
# What one rank does is what was measured.
awk -F, '$3 == 1 && $1 == "cluster" && $6 != $8 { bad = 1 } END { exit bad }' scaling.csv
if "$tenon" plan "$scenes/bird-strike/scene.yaml" --ranks 2 --trial 1 --machine abacus 2>refusal.txt >/dev/null; then exit 1; fi
grep -q "machine 'abacus': expected here, tflops, cluster" refusal.txt
if "$tenon" plan "$scenes/bird-strike/scene.yaml" --trial 1 --machine cluster 2>refusal.txt >/dev/null; then exit 1; fi
grep -q -- "plan --machine: says nothing without --ranks" refusal.txt
if "$tenon" plan "$scenes/bird-strike/scene.yaml" --ranks 2 --trial 1 --csv nowhere/scaling.csv 2>refusal.txt >said.txt; then exit 1; fi
grep -q "nowhere/scaling.csv: cannot be written" refusal.txt
! grep -q "component" said.txt  # before any work
"$tenon" plan "$scenes/bouncing-cube/scene.yaml" --measure-until "0.1 ms" >plan.txt
grep -q "measured per step of [1-9]" plan.txt
echo "1 passed, 0 failed"
