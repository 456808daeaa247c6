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
# Most of the time goes into headers of others. These groups of them are precompiled; a header is checked with the
# largest group of which it reaches every member, so what it lacks is still found.
BASE = ("Eigen/Core", "Eigen/Geometry")
TEXT = (*BASE, "algorithm", "optional", "string")
OWNERS = (*TEXT, "boost/container/static_vector.hpp", "functional", "memory")
THREADS = (*OWNERS, "complex", "condition_variable", "mutex", "thread", "variant")
GROUPS = (("Eigen/Core",), ("string",), BASE, ("nlohmann/json.hpp", "string"),
          (*BASE, "boost/container/static_vector.hpp"), TEXT, OWNERS, THREADS,
          (*THREADS, "map", "nlohmann/json.hpp", "random"))


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
    # A precompiled header names its folder. Without a base directory, ccache does not restore one of another checkout.
    os.environ.pop("CCACHE_BASEDIR", None)
    compiler = [*(["ccache"] if shutil.which("ccache") else []), "clang++", *flags(root)]
    checkout = Checkout(root)

    def group_of(header):
        reached = checkout.reach(header)
        return max((group for group in GROUPS if reached.issuperset(group)), key=len, default=None)

    def precompile(group):
        header = out / f"group{GROUPS.index(group)}.hpp"
        header.write_text("".join(f"#include <{name}>\n" for name in group))
        subprocess.run([*compiler, "-xc++-header", str(header), "-o", f"{header}.pch"], check=True)
        return ["-include-pch", f"{header}.pch"]

    def refused(header):
        result = subprocess.run([*compiler, *options[groups[header]], "-xc++", "-c", str(header), "-o",
                                 str(out / str(header.relative_to(root)).replace("/", "_")) + ".o"], text=True,
                                capture_output=True)
        print(result.stderr, end="")
        return result.returncode != 0

    groups = {header: group_of(header) for header in sorted((root / "src/prostm").rglob("*.hpp"))
              if not header.match(PARTS)}
    needed = set(groups.values()) - {None}
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        options = {None: [], **dict(zip(needed, pool.map(precompile, needed)))}
        count = sum(pool.map(refused, groups))
    print(f"headers: clang accepts {len(groups) - count} of {len(groups)} on their own")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
