#!/bin/bash
# Checks that every tracked C++ file is formatted as clang-format 14 with .clang-format writes it.
# usage: tools/check_format.sh [--fix]
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
how=(--dry-run -Werror)
[[ ${1:-} != --fix ]] || how=(-i)
git -c safe.directory='*' ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 "${how[@]}"
