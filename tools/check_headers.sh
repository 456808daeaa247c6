#!/bin/bash
# Whether clang, too, accepts every header of src/, each on its own: keeps to the C++20 that both compilers know, and
# finds headers that do not include what they use.
# usage: tools/check_headers.sh [FOLDER…]     folders of src/, default all
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../src"
read -ra libraries < <(pkg-config --cflags-only-I eigen3 hdf5 cairo)
find "${@:-.}" -name '*.hpp' -print0 |
  xargs -0 -n 1 -P "$(nproc)" clang++ -std=c++20 -fsyntax-only -x c++-header -Wall -Wextra -Wshadow -Werror \
    -I. "${libraries[@]/#-I/-isystem}"
