#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps that follow moving meshes, other methods and their output, in a scene: the same bits on 1 and 3 ranks and over a
# restart on 2; status and distance in the frames; a full report; clear errors for what does not exist.
source "$(dirname "$0")/common.sh"
moving=(--set end_time="1.5 us" --set output.checkpoint.every="0.5 us" --set transfers.temperature.configuration=current
  --set transfers.displacement.configuration=current --set transfers.displacement.method=moving_least_squares
  --set transfers.temperature.show_outside=true --set transfers.temperature.report=full)
run 1 "$main_job" one "${moving[@]}"
run 3 "$main_job" three "${moving[@]}"
same_state one three
cmp one/history.csv three/history.csv
cp -r one again
rm again/final.h5
rm "$(ls again/checkpoint-*.h5 | sort -V | tail -1)"
run 2 "$main_job" again --restart latest "${moving[@]}"
same_state one again
grep -q "forth and back: values change by" one.log || { echo "no full report"; exit 1; }
grep -aq 'transfer_temperature_distance' one/frames/*mechanics*.vtu || { echo "no distance in the frames"; ls one/frames; exit 1; }

# Refused before any work, with what is there instead.
refused() {
  local expected=$1 text=$2
  shift 2
  local code=0
  mpirun --oversubscribe -n 2 "$tenon" run "$main_job" -o refused "$@" >refused.log 2>&1 || code=$?
  [ $code -eq "$expected" ] && grep -q "$text" refused.log || { echo "exit $code, expected $expected and '$text':"; cat refused.log; exit 1; }
}
refused 2 "moving_least_squares" --set transfers.temperature.method=moving_least_square
refused 2 "no block 'copper'" --set "transfers.temperature.blocks=[copper]"
refused 2 "nearest_projection only" --set transfers.temperature.side_set=foot
echo "1 passed, 0 failed"
