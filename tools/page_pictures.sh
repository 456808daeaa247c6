#!/bin/bash
# Takes the page's pictures for the README and docs, with the release build in Chromium: tools/page_pictures.sh
set -euo pipefail
(($# == 0)) || { sed -n '2s/^# //p' "$0" >&2; exit 2; }
root=$(dirname "$(dirname "$(readlink -f "$0")")")
export PROSTM=$root/build/release/prostm
cd "$root/web"
npm run --silent pictures -- "$root/docs/pictures"
