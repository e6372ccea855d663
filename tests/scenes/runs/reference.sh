#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/scene-reference.md is what `tenon reference` prints; every other command at least starts.
source "$(dirname "$0")/common.sh"
"$tenon" reference >reference.md
diff reference.md "$scenes/../../docs/scene-reference.md" || { echo "run: build/tenon reference > docs/scene-reference.md"; exit 1; }
"$tenon" reference materials >materials.md
grep -q density materials.md
"$tenon" --version >version.txt
grep -q 'HDF5.*VTK.*Zoltan' version.txt
"$tenon" --help >help.txt
grep -q plan help.txt
mpirun --oversubscribe -n 3 "$tenon" plan "$main_job" >plan.txt
for word in "component mechanics" "component conduction" "time step" "skipped" "predicted"; do
  grep -q "$word" plan.txt || { echo "plan does not say '$word':"; cat plan.txt; exit 1; }
done
echo "1 passed, 0 failed"
