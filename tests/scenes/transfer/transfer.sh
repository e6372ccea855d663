#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `tenon transfer` of a run's results: the same file from 1, 2, 3 and 7 ranks, from results of 1 and 3 ranks; refusals with the
# right exit code, one message with advice, and nothing written.
source "$(dirname "$0")/../runs/common.sh"
small=$(dirname "$0")/../fuzz/small.yaml
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

run 1 "$small" bar1
run 3 "$small" bar3
target=$scenes/hot-taylor-bar/bar_tet.msh
# Ranks, output, source, further arguments.
transfer() {
  local ranks=$1 output=$2 source=$3
  shift 3
  mpirun --oversubscribe -n "$ranks" "$tenon" transfer "$source" "$target" -o "$output" "$@" >"$output.txt" 2>&1 || { cat "$output.txt"; exit 1; }
}
for ranks in 1 2 3 7; do transfer $ranks out$ranks.vtu bar1/mechanics.pvd --fields eqps,temperature --status; done
for ranks in 2 3 7; do cmp out1.vtu out$ranks.vtu || fail "$ranks ranks give other bytes than one"; done
for ranks in 2 3 7; do cmp <(sed 's/out[0-9]/out/' out1.vtu.txt) <(sed 's/out[0-9]/out/' out$ranks.vtu.txt) || fail "$ranks ranks say something else than one"; done
# Written by three ranks; only the name of the source may differ in what is said.
transfer 2 other.vtu bar3/mechanics.pvd --fields eqps,temperature --status
cmp out1.vtu other.vtu || fail "results of 3 ranks give other bytes than those of one"
grep -q 'eqps .*interpolate' out1.vtu.txt || { fail "no line of the report"; cat out1.vtu.txt; }
# Back onto the mesh it came from, in pieces, at another time, with amounts.
transfer 3 back.pvtu bar1/conduction.pvd --fields temperature --time '1 us' --at elements --report
grep -q 'state at 1e-06 s' back.pvtu.txt || { fail "not the state at 1 us"; cat back.pvtu.txt; }
grep -q 'there and back: greatest difference [0-9.e+-]* K' back.pvtu.txt || { fail "no round trip"; cat back.pvtu.txt; }
[ -f back.pvtu ] && [ -f back-r0.vtu ] || fail "no pieces"
transfer 2 sum.vtu out1.vtu --fields eqps:conserve --at nodes
grep -Eq 'eqps .* total +conserve .* [0-9.]+e-1[5-9] |eqps .* total +conserve .* 0.0e\+00 ' sum.vtu.txt || { fail "amounts are not kept"; cat sum.vtu.txt; }

# Expected exit code, expected text, arguments.
refused() {
  local expected=$1 text=$2 code=0
  shift 2
  mpirun --oversubscribe -n 3 "$tenon" transfer "$@" -o refused.vtu >out.txt 2>err.txt || code=$?
  [ $code -eq "$expected" ] && [ "$(grep -c -F -- "$text" err.txt)" -eq 1 ] || { fail "$* gave $code:"; cat out.txt err.txt; }
  [ -z "$(ls | grep refused || true)" ] || fail "$* has written something"
}
source=bar1/mechanics.pvd
refused 2 "did you mean 'temperature'?" $source "$target" --fields temperatur
refused 2 "did you mean 'conserve'?" $source "$target" --fields temperature:conserv
refused 2 "did you mean 'nearest'?" $source "$target" --outside neares
refused 2 "temperature" $source "$target" --fields temperature:conserve --kind temperature:point_value
refused 2 "--greatest-distance" $source "$target" --greatest-distance '2 kg'
refused 2 "--part" bar1/all.pvd "$target"
refused 2 "has no fields" "$target" "$target"
refused 2 "--time" out1.vtu "$target" --time '1 us'
refused 3 "nowhere.pvd" nowhere.pvd "$target"
refused 3 "nowhere.exo" $source nowhere.exo
refused 3 "err.txt" $source err.txt
refused 5 "policy error allows none" $source "$target" --outside error
refused 2 "did you mean 'block_1'?" $source "$target" --blocks blok_1
head -c 3000 out1.vtu >short.vtu
refused 3 "short.vtu" short.vtu "$target"
code=0
"$tenon" transfer $source "$target" -o no_such_folder/x.vtu >out.txt 2>err.txt || code=$?
[ $code -eq 3 ] || fail "an output that cannot be written gave $code"
code=0
"$tenon" transfer $source "$target" -o x.stl >out.txt 2>err.txt || code=$?
[ $code -eq 2 ] && grep -q "x.stl" err.txt || fail "an output of an unknown kind gave $code"
[ $failures -eq 0 ] && echo "1 passed, 0 failed"
exit $failures
