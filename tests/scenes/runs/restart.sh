#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# SIGTERM on 2 ranks writes a checkpoint and exits with 6; going on with 3 ranks ends in the bits of an uninterrupted run,
# with the same history and the same frames.
source "$(dirname "$0")/common.sh"
run 2 "$main_job" whole

mpirun --oversubscribe -n 2 "$tenon" run "$main_job" -o stopped >stopped.log 2>&1 &
job=$!
until [ -n "$(ls stopped/checkpoint-*.h5 2>/dev/null)" ]; do sleep 0.1; done
pkill -TERM -P $job  # the ranks: a mpirun that is itself asked to end returns a code of its own
code=0
wait $job || code=$?
[ $code -eq 6 ] || { echo "exit code $code instead of 6"; tail -20 stopped.log; exit 1; }
[ ! -e stopped/final.h5 ] || { echo "a stopped run must not leave final.h5"; exit 1; }

run 3 "$main_job" stopped --restart latest
same_state whole stopped
cmp whole/history.csv stopped/history.csv
cmp <(grep -o 'timestep="[^"]*"' whole/all.pvd) <(grep -o 'timestep="[^"]*"' stopped/all.pvd)

# From a named file, into a folder of its own.
run 1 "$main_job" forked --restart "$(ls stopped/checkpoint-*.h5 | head -1)"
same_state whole forked
# A run that is at its end already only writes the final state again; a longer one goes on from it.
rm forked/checkpoint-*.h5
run 2 "$main_job" forked --restart latest
same_state whole forked
code=0
mpirun --oversubscribe -n 2 "$tenon" run "$(dirname "$0")/../fuzz/small.yaml" -o forked --restart latest >other.log 2>&1 || code=$?
[ $code -eq 3 ] || { echo "a checkpoint of another scene gave exit code $code"; cat other.log; exit 1; }
same_state whole forked
echo "1 passed, 0 failed"
