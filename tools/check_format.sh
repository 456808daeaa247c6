#!/bin/bash
# Whether every tracked C++ file is as clang-format 14 with .clang-format would write it.
# usage: tools/check_format.sh [--fix]
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
how=(--dry-run -Werror)
[[ ${1:-} != --fix ]] || how=(-i)
git -c safe.directory='*' ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 "${how[@]}"
