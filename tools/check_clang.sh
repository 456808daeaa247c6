#!/bin/bash
# Whether clang accepts every header of src/ on its own: finds those that do not include what they use. (The sources are
# clang's too, with warnings as errors, in the fuzzers' build.)
# usage: tools/check_clang.sh [FOLDER…]     folders of src/prostm/, default all
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../src/prostm"
read -ra libraries < <(pkg-config --cflags-only-I eigen3 hdf5 cairo)
# what a source includes once for each vector target (*-inl.hpp) is no header
find "${@:-.}" -name '*.hpp' ! -name '*-inl.hpp' -print0 |
  xargs -0 -n 1 -P "$(nproc)" clang++ -xc++-header -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Werror \
    -I.. "${libraries[@]/#-I/-isystem}"
