#!/usr/bin/env python3
"""Compiles the adapter to Ultraleap's SDK against the stand-in of its interface, with every compiler available.

usage: compile_adapter.py ROOT EIGEN     ROOT is the repository, EIGEN the folder with Eigen's headers

Any warning is an error. Prints what it compiled, and exits 1 if something did not compile, 77 without a compiler.
"""

import shutil
import subprocess
import sys
from pathlib import Path

COMPILERS = ["g++", "clang++"]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wno-sign-conversion", "-Wdouble-promotion",
            "-Wold-style-cast", "-Wnon-virtual-dtor", "-Woverloaded-virtual", "-Werror"]
ADAPTER = ["device/ultraleap/ultraleap_array.cpp", "device/ultraleap/detail/ultraleap_session.cpp",
           "device/ultraleap/detail/ultraleap_emission.cpp"]


def compiles(compiler, root, eigen):
    sources = [str(root / "src/prostm" / name) for name in ADAPTER]
    command = [compiler, "-std=c++20", "-fsyntax-only", "-DPROSTM_ULTRALEAP", *WARNINGS, f"-I{root / 'src'}",
               f"-I{root / 'tests/support/ultraleap_sdk/include'}", "-isystem", eigen, *sources]
    return subprocess.run(command, check=False).returncode == 0


def main():
    root, eigen = Path(sys.argv[1]).resolve(), sys.argv[2]
    present = [compiler for compiler in COMPILERS if shutil.which(compiler)]
    if not present:
        print("no compiler is here")
        return 77
    failed = False
    for compiler in present:
        good = compiles(compiler, root, eigen)
        failed = failed or not good
        print(f"{compiler}: {'the adapter compiles without a warning' if good else 'failed'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
