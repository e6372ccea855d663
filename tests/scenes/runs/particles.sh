#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Shipped scenes with particles: the first part of the dam break is the same on 1, 2, 3 and 7 ranks and through a restart on another
# count, nothing is lost, and pictures show the particles. Scenes that make no sense are refused with the place and what to do.
source "$(dirname "$0")/common.sh"
dam=$scenes/dam-break/scene.yaml
short=(--set end_time="0.1 s" --set output.checkpoint.every="0.05 s" --set output.frames.every="0.1 s")
for ranks in 1 2 3 7; do
  run $ranks "$dam" dam$ranks "${short[@]}"
  same_state dam1 dam$ranks
  cmp dam1/history.csv dam$ranks/history.csv
done
run 3 "$dam" again --restart "$(ls dam2/checkpoint-*.h5 | head -1)" "${short[@]}"
same_state dam1 again
awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  NR == 2 { mass = $column["mass"] }
  { if ($column["mass"] != mass) lost++; rows++ }
  END { printf "dam break: mass %.6f kg/m in %d rows\n", mass, rows; exit lost > 0 || rows < 10 }' dam1/history.csv

refused() {
  local text=$1
  shift
  if "$tenon" check "$dam" "$@" >out.txt 2>err.txt; then echo "not refused: $*"; exit 1; fi
  grep -q -F -- "$text" err.txt || { echo "$* gave:"; cat err.txt; exit 1; }
}
refused "has no block 'wals', did you mean 'walls'" --set components.flow.blocks.wals="{material: water}" || exit 1
refused "open: there is no side 'y_mx'" --set meshes.tank.bodies.walls.open="[y_mx]"
refused "either periodic or with symmetry planes" --set components.flow.periodic.x="[0, 4]" --set components.flow.symmetry_planes.x_min=0
refused "no stiffness without energy" --set components.flow.formulation=fluid --set materials.water.equation_of_state='{type: ideal_gas, gamma: 1.4}'
refused "fluid: the formulation is 'gas'" --set components.flow.formulation=gas --set components.flow.fluid.density_diffusion=0.2
refused "spacing: has no value; expected a length" --set meshes.tank.spacing=null
echo "1 passed, 0 failed"
