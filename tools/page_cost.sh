#!/bin/bash
# Measures how a page in Chromium, drawn by the processor, slows a run of the release build: tools/page_cost.sh [ROUNDS]
# Each of the ROUNDS (5) takes one and a half minutes; nothing else should run meanwhile.
set -euo pipefail
[[ $# -eq 0 || ( $# -eq 1 && $1 =~ ^[1-9][0-9]*$ ) ]] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
root=$(dirname "$(dirname "$(readlink -f "$0")")")
export PROSTM=$root/build/release/prostm
cd "$root/web"
npm run --silent cost -- "$@"
