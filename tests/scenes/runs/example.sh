#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The C++ example composes components without a scene, closes its ledger, and prints the same digits on any number of ranks.
source "$(dirname "$0")/common.sh"
for ranks in 1 2 3; do
  mpirun --oversubscribe -n $ranks "$(dirname "$tenon")/coupled_bar" >ranks$ranks.txt
  grep -v 'ledger error' ranks$ranks.txt >digits$ranks.txt
  cmp digits1.txt digits$ranks.txt
done
cat ranks1.txt
awk '/transferred_heat/ { arrived = $3 } /heat_generated/ { made = $3 } END { d = (arrived - made) / made; exit !(made > 1 && d < 1e-12 && d > -1e-12) }' digits1.txt
awk '/ledger error/ { exit !($3 < 1e-12) }' ranks1.txt
echo "1 passed, 0 failed"
