#!/bin/bash
# Makes the reference of the C++ headers, build/api/html, and fails on doxygen's warnings.
# usage: tools/build_api.sh
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
rm -rf build/api
mkdir -p build
doxygen docs/Doxyfile
