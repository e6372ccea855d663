#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The main job on 1, 2, 3, 4 and 7 ranks ends in the same bits, and so does its history.
source "$(dirname "$0")/common.sh"
for ranks in 1 2 3 4 7; do
  run $ranks "$main_job" ranks$ranks
  same_state ranks1 ranks$ranks
  cmp ranks1/history.csv ranks$ranks/history.csv
done
echo "1 passed, 0 failed"
