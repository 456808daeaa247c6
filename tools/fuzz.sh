#!/bin/bash
# Fuzzes one parser with the asan build (./run test --full builds it).
# usage: tools/fuzz.sh NAME SECONDS          e.g. tools/fuzz.sh field_json_fuzz 600
# Starts from fuzz/corpus/NAME if it exists; inputs that break the parser are kept in build/asan/findings.
set -euo pipefail
[[ $# -eq 2 ]] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
name=$1 seconds=$2
root=$(dirname "$(readlink -f "$0")")/..
findings=$root/build/asan/findings
mkdir -p "$findings"

# new inputs are used in this run only: the committed corpus stays unchanged
corpus=$(mktemp -d)
trap 'rm -rf "$corpus"' EXIT
if [[ -d $root/fuzz/corpus/$name ]]; then cp -r "$root/fuzz/corpus/$name/." "$corpus"; fi
"$root/build/asan/$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
  -artifact_prefix="$findings/$name-" "$corpus"
