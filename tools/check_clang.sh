#!/bin/bash
# Checks that clang accepts every header of src/ on its own, which finds missing includes. (The build asan compiles the
# sources with clang, with warnings as errors.) With ccache, headers that have not changed take no time.
# usage: tools/check_clang.sh [FOLDER…]     folders of src/prostm/, default all
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../src/prostm"
read -ra libraries < <(pkg-config --cflags-only-I eigen3 hdf5 cairo)
compiler=(clang++)
command -v ccache >/dev/null && compiler=(ccache clang++)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# a stand-in replaces Ultraleap's SDK, which must not be redistributed
# a file that a source includes once for each vector target (*-inl.hpp) is not checked on its own
find "${@:-.}" -name '*.hpp' ! -name '*-inl.hpp' -print0 |
  xargs -0 -P "$(nproc)" -I{} sh -c 'o=$1/$(echo "$2" | tr / _).o; shift 2; exec "$@" -o "$o"' \
    sh "$out" {} "${compiler[@]}" -xc++ -std=c++20 -c {} -MD -Wall -Wextra -Wshadow -Werror \
    -Wno-pragma-once-outside-header -I.. "${libraries[@]/#-I/-isystem}" -isystem ../../tests/support/ultraleap_sdk/include
