#!/bin/bash
# Draws the pictures of the README and docs with the release build and its Python module: tools/pictures.sh
set -euo pipefail
(($# == 0)) || { sed -n '2s/^# //p' "$0" >&2; exit 2; }
root=$(dirname "$(dirname "$(readlink -f "$0")")")
prostm=$root/build/release/prostm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$root/docs/pictures"
cd "$work"
"$prostm" run --scene one-plume --seconds 6 --as-fast-as-possible --figure-at 4.5 \
  --figure "$root/docs/pictures/one-plume.png"
PYTHONPATH=$root/build/release/python /usr/bin/python3 "$root/tools/draw_animation.py" "$prostm" \
  "$root/docs/pictures/four-plumes.svg"
for scene in one-plume four-plumes; do
  "$prostm" capture --scene $scene --hand study --frames 120 --out $scene.h5
done
"$prostm" plan four-plumes.h5 --frame 100 --preset paper --figure "$root/docs/pictures/plan.png"
"$root/build/release/planner_bench" --frames 2 --seeds 1 --bending-figure "$root/docs/pictures/bending.png"
"$root/build/release/am_bench" --frames 2 --figure "$root/docs/pictures/am.png" one-plume.h5 four-plumes.h5
"$root/build/release/skin_lab" --figures "$root/docs/pictures"
"$root/build/release/plumes_lab" --curves "$root/docs/pictures/refinement.png"
"$root/build/release/methods_lab" --frames 1 --figure "$root/docs/pictures/methods.png" \
  --gallery "$root/docs/pictures/gallery.png"
