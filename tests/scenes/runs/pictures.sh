#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A run's frames open where a user would open them: pictures by `tenon picture` without a display, and ParaView if it is here.
source "$(dirname "$0")/common.sh"
run 2 "$main_job" bar --set "end_time=20 us"
env -u DISPLAY "$tenon" picture bar --last >picture.log
for picture in last history; do
  [ "$(head -c 4 bar/pictures/$picture.png | tail -c 3)" = PNG ] || { echo "no picture $picture.png"; exit 1; }
  [ "$(stat -c %s bar/pictures/$picture.png)" -gt 20000 ] || { echo "$picture.png is nearly empty"; exit 1; }
done
echo 'import paraview.simple' >try.py
if command -v pvbatch >/dev/null && xvfb-run -a pvbatch try.py >/dev/null 2>&1; then
  xvfb-run -a pvbatch "$(dirname "$0")/../paraview/open_frames.py" "$PWD/bar" 6
else
  echo "ParaView with its Python modules is not installed: frames were read through VTK only"
fi
echo "1 passed, 0 failed"
