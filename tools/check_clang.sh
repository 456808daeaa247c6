#!/bin/bash
# Whether clang, too, accepts src/: every header on its own and every source. Keeps the code to the C++20 that both compilers
# know, and finds headers that do not include what they use.
# usage: tools/check_clang.sh [FOLDER…]     folders of src/, default all
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../src"
read -ra libraries < <(pkg-config --cflags-only-I eigen3 hdf5 cairo)
find "${@:-.}" \( -name '*.hpp' -printf '-xc++-header\0%p\0' \) -o \( -name '*.cpp' -printf '-xc++\0%p\0' \) |
  xargs -0 -n 2 -P "$(nproc)" clang++ -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Werror \
    -I. "${libraries[@]/#-I/-isystem}"
