#!/bin/bash
# Checks that clang accepts every header of src/ on its own, which finds missing includes. (The fuzzers' build compiles
# the sources with clang, with warnings as errors.)
# usage: tools/check_clang.sh [FOLDER…]     folders of src/prostm/, default all
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../src/prostm"
read -ra libraries < <(pkg-config --cflags-only-I eigen3 hdf5 cairo)
# a file that a source includes once for each vector target (*-inl.hpp) does not stand alone
find "${@:-.}" -name '*.hpp' ! -name '*-inl.hpp' -print0 |
  xargs -0 -n 1 -P "$(nproc)" clang++ -xc++-header -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Werror \
    -I.. "${libraries[@]/#-I/-isystem}"
