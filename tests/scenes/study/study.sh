#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The shipped study of the elastic wave, made small: second order, the same on two ranks, not repeated, and a run that
# fails is recorded while the rest goes on.
source "$(dirname "$0")/../runs/common.sh"
fail() { echo "$1"; exit 1; }
study() { # ranks, folder, further arguments
  local ranks=$1 folder=$2
  shift 2
  mpirun --oversubscribe -n "$ranks" "$tenon" study "$@" -o "$folder" >"$folder.log" 2>&1
}
sed -e 's/50, 100, 200, 400/40, 80, 160/' -e 's/20 mm, 10 mm, 5 mm, 2.5 mm/25 mm, 12.5 mm, 6.25 mm/' -e "s#scene: scene.yaml#scene: $scenes/elastic-wave/scene.yaml#" \
  "$scenes/elastic-wave/study.yaml" >wave.yaml

study 1 one wave.yaml || { cat one.log; exit 1; }
[ "$(wc -l <one/study.csv)" = 4 ] || fail "study.csv has not three rows"
order=$(tail -1 one/study.csv | cut -d, -f8)
awk -v p="$order" 'BEGIN { exit !(p > 1.85 && p < 2.1) }' || fail "the order is $order"
[ -s one/study.png ] || grep -q 'tenon picture one' one.log || fail "neither a picture nor a word about it"
ls one/N-160_*/log.txt >/dev/null || fail "no log of a run"

# The same numbers on two ranks, apart from the times.
study 2 two wave.yaml --no-picture || { cat two.log; exit 1; }
cut -d, -f1-9 one/study.csv >one.txt
cut -d, -f1-9 two/study.csv >two.txt
cmp one.txt two.txt

# Nothing runs twice; a changed setting does.
stamp=$(stat -c %Y.%s one/N-160_*/final.h5)
study 1 one wave.yaml --no-picture
[ "$(grep -c 'not repeated' one.log)" = 3 ] || { cat one.log; fail "a run was repeated"; }
[ "$stamp" = "$(stat -c %Y.%s one/N-160_*/final.h5)" ] || fail "a final state was written again"
cut -d, -f1-9 one/study.csv | cmp - one.txt

# What is damaged is made again: a final state that is cut short, a history that is gone, a record that is none.
cut_short() { truncate -s 1000 two/N-40_*/final.h5; }
lose() { rm two/N-40_*/history.csv; }
void_record() { sed -i 's/"seconds": [^,]*,/"seconds": null,/' two/N-40_*/run.json; }
for damage in cut_short lose void_record; do
  $damage
  study 2 two wave.yaml --no-picture || { cat two.log; fail "not repaired: $damage"; }
  [ "$(grep -c 'not repeated' two.log)" = 2 ] || { cat two.log; fail "$damage: one run should be repeated"; }
  cut -d, -f1-9 two/study.csv | cmp - one.txt
done
# The frames are part of what a run is.
{ cat wave.yaml; echo "frames: true"; } >frames.yaml
study 1 one frames.yaml --no-picture
[ "$(grep -c 'not repeated' one.log)" = 0 ] || { cat one.log; fail "a run without frames was taken for one with"; }

# Of two runs the second inverts or is refused: told, recorded, exit code not zero, the third still runs.
set +e
study 1 broken "$scenes/elastic-wave/scene.yaml" --set end_time="40 us" --set meshes.bar.elements="[20, 1, 1]" \
  --vary maximum_steps=1000,2,1001 --quantity kinetic_energy --reference 'max(t, 1e-3)' --no-picture
code=$?
set -e
[ $code = 2 ] || { cat broken.log; fail "exit code $code"; }
[ "$(grep -c ',done$' broken/study.csv)" = 2 ] || { cat broken/study.csv; fail "two runs should be done"; }

# A column that does not exist ends the study with the nearest one.
if study 1 typo "$scenes/elastic-wave/scene.yaml" --set end_time="1 us" --vary meshes.bar.elements.0=10,20 --quantity kinetic_enrgy --no-picture; then
  fail "a misspelt column was accepted"
fi
grep -q "did you mean 'kinetic_energy'" typo.log || { cat typo.log; fail "no suggestion"; }
for word in frob stdy; do
  if "$tenon" $word >word.log 2>&1; then fail "the command $word was accepted"; fi
done
grep -q "did you mean 'study'" word.log || { cat word.log; fail "no suggestion for a command"; }
echo "1 passed, 0 failed"
