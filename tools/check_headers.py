#!/usr/bin/env python3
"""Checks that clang accepts every header of src/prostm/ on its own, which finds missing includes.

usage: check_headers.py FOLDER

FOLDER is a checkout. The build asan compiles the sources with clang, with warnings as errors. With ccache, headers that
have not changed take no time. Exit status 1 when a header is refused; clang's messages are printed.
"""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from check_includes import Checkout

# part of the sources that include them once for each vector target
PARTS = "*-inl.hpp"


def flags(root):
    """Returns the options of the compiler. A replica replaces Ultraleap's SDK, which must not be redistributed."""
    libraries = subprocess.run(["pkg-config", "--cflags-only-I", "eigen3", "hdf5", "cairo"], check=True, text=True,
                               capture_output=True).stdout.split()
    system = [name.removeprefix("-I") for name in libraries] + [str(root / "tests/support/ultraleap_sdk/include")]
    return ["-std=c++20", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-pragma-once-outside-header",
            "-Xclang", "-fno-pch-timestamp", "-I", str(root / "src"), *(f"-isystem{folder}" for folder in system)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = Path(sys.argv[1]).resolve()
    out = root / "build/headers"
    out.mkdir(parents=True, exist_ok=True)
    compiler = [*(["ccache"] if shutil.which("ccache") else []), "clang++", *flags(root)]
    # Most of the time is Eigen's. It is precompiled for the headers that reach it, and for no other.
    eigen = out / "eigen.hpp"
    eigen.write_text("#include <Eigen/Core>\n")
    subprocess.run([*compiler, "-xc++-header", str(eigen), "-o", f"{eigen}.pch"], check=True)
    checkout = Checkout(root)

    def refused(header):
        reaches_eigen = any(name.startswith("Eigen/") for name in checkout.reach(header))
        options = ["-include-pch", f"{eigen}.pch"] if reaches_eigen else []
        result = subprocess.run([*compiler, *options, "-xc++", "-c", str(header), "-o",
                                 str(out / str(header.relative_to(root)).replace("/", "_")) + ".o"], text=True,
                                capture_output=True)
        print(result.stderr, end="")
        return result.returncode != 0

    headers = sorted(path for path in (root / "src/prostm").rglob("*.hpp") if not path.match(PARTS))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        count = sum(pool.map(refused, headers))
    print(f"headers: clang accepts {len(headers) - count} of {len(headers)} on their own")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
