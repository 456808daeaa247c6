#!/bin/bash
# Tries the planner's library alone on a bare Debian 12 with only a compiler, CMake and the library's dependencies.
set -euo pipefail

usage() {
  cat <<'USAGE'
usage: tools/bare_library.sh [--folder DIR] [--keep]

Builds the commit that is checked out here with PROSTM_PROGRAM=OFF in a minimal Debian 12, installs it, deletes sources
and build, and builds and runs examples/01_plan.cpp in the CMake project of five lines that docs/guides/cpp.md shows.
tools/bare_debian.sh sets the Debian up: it takes the options, and needs root, debootstrap and a Debian mirror.

example: tools/bare_library.sh --folder /var/tmp/bare
USAGE
}

for argument in "$@"; do
  case $argument in -h | --help) usage; exit 0 ;; esac
done

packages=(g++ cmake ninja-build libeigen3-dev libboost1.81-dev libhwy-dev libfmt-dev nlohmann-json3-dev)
install="DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends ${packages[*]}"

exec "$(dirname "$0")/bare_debian.sh" "$@" \
  'apt-get -q update >/dev/null' \
  "$install >/dev/null" \
  'cmake -G Ninja -B build -DPROSTM_PROGRAM=OFF' \
  'cmake --build build' \
  'cmake --install build' \
  'mkdir -p /srv/own && cp examples/01_plan.cpp /srv/own' \
  "sed -n '/^\`\`\`cmake/,/^\`\`\`/ { /^\`/!p }' docs/guides/cpp.md >/srv/own/CMakeLists.txt && rm -r src build" \
  'cd /srv/own && cmake -G Ninja -B build && cmake --build build && ./build/own'
