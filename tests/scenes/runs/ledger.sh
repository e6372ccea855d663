#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# In every shipped scene (of the long ones, their first part) the energy ledger closes to 1e-11 at every row of its history; in
# the main job, at every step, the heat on the thermal mesh is the Taylor-Quinney share of the plastic work on the mechanics mesh to 1e-10.
source "$(dirname "$0")/common.sh"
for scene in "$scenes"/*/scene.yaml; do
  name=$(basename "$(dirname "$scene")")
  every=()
  [ "$name" = hot-taylor-bar ] && every=(--set "output.history.every=1 steps")
  [ "$name" = plate-perforation ] && every=(--set end_time="20 us")
  [ "$name" = tube-crush ] && every=(--set end_time="0.5 ms")
  [ "$name" = bird-strike ] && every=(--set end_time="0.3 ms" --set "output.history.every=10 steps")
  [ "$name" = dam-break ] && every=(--set end_time="0.2 s")
  case $name in  # paper.sh has them
    can-crush | penetrator | wing-and-pole | foam-crush | rod-through-plate) continue ;;
  esac
  run 2 "$scene" "$name" ${every[@]+"${every[@]}"}
  awk -F, -v name="$name" -v limit=1e-11 '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { error = $column["energy_error"]; if (error > worst) worst = error; rows++ }
    END { printf "%s: greatest ledger error %.1e in %d rows\n", name, worst, rows; exit !(rows > 10 && worst <= limit) }' "$name/history.csv"
done
awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  { share = 0.9 * $column["plastic_work"]; heat = $column["thermal_energy"] + 0; arrived = $column["transfer.plastic_heat.arrived"]
    if (share > 0) { d = (arrived - share) / share; if (d < 0) d = -d; if (d > worst) worst = d; rows++ } }
  END { printf "heat that arrived against the share of plastic work: %.1e in %d rows\n", worst, rows; exit !(rows > 1000 && worst <= 1e-10) }' hot-taylor-bar/history.csv
echo "1 passed, 0 failed"
