#!/bin/bash
# Measures what a page in Chromium, drawn by the processor, costs a run of the release build: tools/page_cost.sh [ROUNDS]
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "$0")")")
export PROSTM=$root/build/release/prostm
cd "$root/web"
npm run --silent cost -- "$@"
