#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Element-steps per second and core of shells (whole step): 256 x 256 quadrilaterals, elastic and J2 with 5 layers.
set -euo pipefail
tenon=$(cd "${1:?build folder}" && pwd)/tenon
source "$(dirname "$0")/../../scripts/mpi-environment"
cd "$(mktemp -d)"
scene() {
  cat <<YAML
title: speed of shells
end_time: 60 us
meshes:
  plate: {type: plate, length_x: 1, length_y: 1, elements_x: 256, elements_y: 256}
materials:
  steel:
    density: 7850
    elastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}
    $1
components:
  mechanics:
    type: explicit_mechanics
    mesh: plate
    material: steel
    shell: {thickness: 2 mm, points: 5}
    initial_velocities: [{gradient: [-2000, 300, 0, 0, 500, 0, 0, 0, 0]}]
    time_step: {fixed: 0.3 us}
output: {frames: {every: 1 s}, history: {every: 1 s}, log: {every: 1 s}}
YAML
}
scene "" >elastic.yaml
scene "plasticity: {type: linear_hardening, yield_stress: 400 MPa, hardening_modulus: 1 GPa}" >j2.yaml
for material in elastic j2; do
  mpirun -n 1 "$tenon" run $material.yaml -o $material >/dev/null
  python3 - $material $material/summary.json <<'PYTHON'
import json, sys
summary = json.load(open(sys.argv[2]))
phases = {p["phase"]: p["seconds"] for p in summary["phases"] if p["phase"].startswith("mechanics")}
rate = 256**2 * summary["steps"] / sum(phases.values())
print(f"{sys.argv[1]}: {rate / 1e6:.2f} million element-steps per second")
PYTHON
done
