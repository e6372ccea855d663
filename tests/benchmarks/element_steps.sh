#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Element-steps per second and core of explicit mechanics (whole step): 64^3 hexahedra, elastic and J2, 1 and 2 ranks.
set -euo pipefail
tenon=$(cd "${1:?build folder}" && pwd)/tenon
source "$(dirname "$0")/../../scripts/mpi-environment"
cd "$(mktemp -d)"
scene() {
  cat <<YAML
title: speed
end_time: 100 us
meshes:
  box: {type: box, high: [1, 1, 1], elements: [64, 64, 64]}
materials:
  steel:
    density: 7850
    elastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}
    $1
components:
  mechanics:
    type: explicit_mechanics
    mesh: box
    material: steel
    initial_velocities: [{gradient: [-2000, 300, 0, 0, 500, 0, 0, 0, 700]}]
    time_step: {fixed: 1 us}
output: {frames: {every: 1 s}, history: {every: 1 s}, log: {every: 1 s}}
YAML
}
scene "" >elastic.yaml
scene "plasticity: {type: linear_hardening, yield_stress: 400 MPa, hardening_modulus: 1 GPa}" >j2.yaml
for material in elastic j2; do
  for ranks in 1 2; do
    mpirun -n $ranks "$tenon" run $material.yaml -o $material$ranks >/dev/null
    python3 - $material $ranks $material$ranks/summary.json <<'PYTHON'
import json, sys
summary = json.load(open(sys.argv[3]))
seconds = sum(p["seconds"] for p in summary["phases"] if p["phase"].startswith("mechanics"))
rate = 64**3 * summary["steps"] / seconds / int(sys.argv[2])
print(f"{sys.argv[1]}, {sys.argv[2]} ranks: {rate / 1e6:.2f} million element-steps per second and core")
PYTHON
  done
done
