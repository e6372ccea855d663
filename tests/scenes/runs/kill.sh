#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# kill -9 of one rank or of the whole run at random moments, as often as the third argument says: each time the run goes on from
# the latest checkpoint, and in the end the bits are those of an uninterrupted run.
source "$(dirname "$0")/common.sh"
kills=$3
settings=(--set "output.checkpoint.every=100 steps" --set "end_time=40 us")
RANDOM=20
start=$(date +%s%N)
run 2 "$main_job" whole "${settings[@]}"
milliseconds=$((($(date +%s%N) - start) / 1000000))

for ((i = 1; i <= kills; ++i)); do
  folder=killed$i
  mpirun --oversubscribe -n 2 "$tenon" run "$main_job" -o $folder "${settings[@]}" >$folder.log 2>&1 &
  job=$!
  sleep "$(awk -v t=$((milliseconds * RANDOM / 32768)) 'BEGIN { print t / 1000 }')"
  ranks=($(pgrep -P $job || true))
  if ((i % 2)) && [ ${#ranks[@]} -gt 0 ]; then
    kill -9 "${ranks[$((RANDOM % ${#ranks[@]}))]}" 2>/dev/null || true
  else
    kill -9 $job ${ranks[@]+"${ranks[@]}"} 2>/dev/null || true
  fi
  wait $job 2>/dev/null || true
  run $((1 + RANDOM % 3)) "$main_job" $folder "${settings[@]}" --restart latest
  same_state whole $folder
  cmp whole/history.csv $folder/history.csv
  echo "kill $i: $(grep -c '' <(ls $folder/checkpoint-*.h5)) checkpoints kept; $(grep -E 'continuing|no checkpoint' $folder.log)"
  rm -rf $folder
done
echo "$kills passed, 0 failed"
