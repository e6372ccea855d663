#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Shipped scenes with contact: the first part of the crushed tube is the same on 1, 2, 3 and 7 ranks, through a restart on another
# count, and with every skip of the search forced off. Two bars exchange their velocities. A cube that bounces keeps its energy.
source "$(dirname "$0")/common.sh"
tube=$scenes/tube-crush/scene.yaml
short=(--set end_time="0.12 ms" --set output.checkpoint.every="0.05 ms" --set output.frames.every="1 ms")
for ranks in 1 2 3 7; do
  run $ranks "$tube" tube$ranks "${short[@]}"
  same_state tube1 tube$ranks
  cmp tube1/history.csv tube$ranks/history.csv
done
run 3 "$tube" again --restart "$(ls tube2/checkpoint-*.h5 | head -1)" "${short[@]}"
same_state tube1 again
run 2 "$tube" always "${short[@]}" --set contact.always_search=true
same_state tube1 always

value() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i } END { print $c }' "$1/history.csv"
}
run 2 "$scenes/two-bar-impact/scene.yaml" bars
awk -v left="$(value bars left_end_x)" -v right="$(value bars right_end_x)" 'BEGIN {
  printf "ends of the bars: %.4f and %.4f m/s, exact 0 and 10\n", left, right; exit !(left < 0.5 && left > -0.5 && right > 9.5 && right < 10.5) }'

run 1 "$scenes/bouncing-cube/scene.yaml" cube
awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  { e = $column["kinetic_energy"] + $column["internal_energy"] + $column["hourglass_energy"] + $column["contact_energy"] + $column["friction_energy"] - $column["body_work"]
    if (NR == 2) start = e
    d = e - start; if (d < 0) d = -d; if (d > worst) worst = d; rows++ }
  END { printf "bouncing cube: energy off by at most %.2g J of 5.4 J in %d rows\n", worst, rows; exit !(rows > 50 && worst < 0.027) }' cube/history.csv
echo "1 passed, 0 failed"
