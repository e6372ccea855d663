#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Bad input is refused before any work: the right exit code, one message with place and advice, on any number of ranks, and
# nothing that was written before is touched.
source "$(dirname "$0")/common.sh"
small=$(dirname "$0")/../fuzz/small.yaml
failures=0

# Expected exit code, expected text, arguments of tenon.
refused() {
  local expected=$1 text=$2 code ranks
  shift 2
  for ranks in 1 3; do
    code=0
    mpirun --oversubscribe -n $ranks "$tenon" "$@" >out.txt 2>err.txt || code=$?
    if [ $code -ne "$expected" ] || [ "$(grep -c -F -- "$text" err.txt)" -ne 1 ]; then
      echo "FAILED on $ranks ranks: $* gave exit code $code (expected $expected) and:"
      cat out.txt err.txt
      failures=$((failures + 1))
    fi
  done
}
# A copy of the small scene with a line changed.
changed() {
  sed "$1" "$small" >changed.yaml
  cmp -s changed.yaml "$small" && { echo "the edit '$1' changes nothing"; exit 1; }
  echo changed.yaml
}

refused 2 "changed.yaml:11:" check "$(changed 's/density: 8.96 g.cm^3/density: 5 m/')"
refused 2 "youngs_modulus" check "$(changed 's/youngs_modulus/youngs_modulos/')"
refused 2 "'bottom'" check "$(changed 's/node_sets: bottom/node_sets: botom/')"
refused 2 "poissons_ratio" check "$(changed 's/poissons_ratio: 0.34/poissons_ratio: 0.5/')"
refused 2 "end_time" run "$(changed '/^end_time/d')" -o kept
refused 2 "plastic_heat" check "$(changed 's/from: mechanics.plastic_heat/from: mechanics.plastic_heet/')"
refused 2 "changed.yaml:" check "$(changed 's/^meshes:/meshes: [/')"
refused 2 "nowhere.yaml" run nowhere.yaml
refused 2 "--set" check "$small" --set end_tim=5
refused 2 "tenon study" check "$scenes/taylor-bar-copper/study.yaml"
refused 2 "did you mean 'resolution'" check "$scenes/penetrator/scene.yaml" --set parameters.resolutoin=2
# Beside another component: steady must know when, a step of its own must see the heat.
refused 2 "changed.yaml:40:" check "$(changed "s/stepper: crank_nicolson/stepper: steady\n    prescribed_temperatures: [{node_set: z_min, temperature: 300 K}]/; s/    time_step: {fixed: 0.2 us}//")"
refused 2 "every: source_step" check "$(changed 's/stepper: crank_nicolson/stepper: tr_bdf2/; s/    time_step: {fixed: 0.2 us}//; s/, every: source_step//')"
refused 2 "changed.yaml:41:" check "$(changed 's/{fixed: 0.2 us}/{fixed: 0.2 us, maximum: 1 us}/')"
refused 3 "missing.exo" check "$(changed 's/type: cylinder.*}/type: file, file: missing.exo}/')"
refused 3 "checkpoint" run "$small" --restart "$small" -o kept
head -c 1000 "$scenes/hot-taylor-bar/bar_hex.exo" >short.exo
refused 3 "short.exo" check "$(changed 's/type: cylinder.*}/type: file, file: short.exo}/')"

# Two faults are told in one go.
mpirun --oversubscribe -n 2 "$tenon" check "$(changed 's/density: 8.96 g.cm^3/density: 5 m/; s/mesh: solid/mesh: solod/; s/  type: johnson_cook/  type: johnson_cok/')" 2>err.txt && exit 1
[ "$(grep -c 'changed.yaml:[0-9]*:[0-9]*:' err.txt)" -ge 2 ] || { echo "not all faults at once:"; cat err.txt; failures=$((failures + 1)); }

# Results of an earlier run survive a refused one.
run 1 "$small" kept
before=$(ls -l --time-style=full-iso kept | md5sum)
refused 2 "end_time" run "$(changed '/^end_time/d')" -o kept
refused 2 "maximum_steps" run "$small" --set "end_time=1000 s" -o kept
[ "$before" = "$(ls -l --time-style=full-iso kept | md5sum)" ] || { echo "a refused run touched the results"; failures=$((failures + 1)); }
[ $failures -eq 0 ] && echo "1 passed, 0 failed"
exit $failures
