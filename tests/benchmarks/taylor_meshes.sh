#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The copper Taylor bar on three meshes: mesh, elements, steps, seconds, length, foot radius, greatest plastic strain, as CSV.
set -euo pipefail
tenon=$(cd "${1:?build folder}" && pwd)/tenon
root=$(cd "$(dirname "$0")/../.." && pwd)
source "$root/scripts/mpi-environment"
cd "$(mktemp -d)"
echo "core x shell x axial,elements,steps,seconds,L_mm,R_mm,eqps"
for mesh in "4 2 40" "8 4 60" "12 6 100"; do
  read -r core shell axial <<<"$mesh"
  mpirun -n 2 "$tenon" run "$root/apps/scenes/taylor-bar-copper/scene.yaml" -o out --set meshes.bar.core="$core" \
    --set meshes.bar.shell="$shell" --set meshes.bar.axial="$axial" >/dev/null
  python3 - "$core x $shell x $axial" <<'PYTHON'
import csv, json, sys
row = list(csv.DictReader(open("out/history.csv")))[-1]
summary = json.load(open("out/summary.json"))
print(f"{sys.argv[1]},{summary['components'][0]['elements']},{summary['steps']},{summary['wall_seconds']:.1f},"
      f"{32.4 + 1e3 * float(row['free_end_z']):.4f},{3.2 + 1e3 * float(row['foot_edge_x']):.4f},{float(row['max_eqps']):.3f}")
PYTHON
done
