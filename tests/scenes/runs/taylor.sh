#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The shipped Taylor bars end within the published spread. Copper, 227 m/s: length 21.47 mm, foot radius 7.18 mm.
# 42CrMo4, 287 m/s, adiabatic Johnson-Cook: length 26.55 mm, foot diameter 11.22 mm, 597 degC, eqps 1.84 (three-dimensional
# Abaqus values quoted in the examples of DynELA by Pantale).
source "$(dirname "$0")/common.sh"
last() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i } END { print $c }' "$1/history.csv"
}
# What, value, expected, relative tolerance.
near() {
  awk -v what="$1" -v v="$2" -v e="$3" -v t="$4" 'BEGIN { d = (v - e) / e; printf "%s: %.5g, expected %.5g, off by %.2f %% of %.2f %%\n", what, v, e, 100 * d, 100 * t; exit !(d <= t && d >= -t) }'
}
of() { awk -v a="$1" -v b="$2" -v s="$3" 'BEGIN { print s * (a + b) }'; }

run 2 "$scenes/taylor-bar-copper/scene.yaml" copper
near "copper length, mm" "$(of 32.4e-3 "$(last copper free_end_z)" 1e3)" 21.47 0.005
near "copper foot radius, mm" "$(of 3.2e-3 "$(last copper foot_edge_x)" 1e3)" 7.18 0.02

run 2 "$scenes/taylor-bar-42crmo4/scene.yaml" steel
near "42CrMo4 length, mm" "$(of 32.4e-3 "$(last steel free_end_z)" 1e3)" 26.55 0.004
near "42CrMo4 foot diameter, mm" "$(of 3.2e-3 "$(last steel foot_edge_x)" 2e3)" 11.22 0.015
near "42CrMo4 temperature, degC" "$(of -273.15 "$(last steel max_temperature)" 1)" 597 0.05
near "42CrMo4 eqps" "$(last steel max_eqps)" 1.84 0.06
echo "1 passed, 0 failed"
