#!/usr/bin/env python3
"""Measures the house: folder sizes, longest files, cyclic includes inside the stages.

usage: house.py [ROOT]     ROOT is a checkout of prostm (default: the folder above this file)

Prints one line for each measure. A module is a header with the sources of its name. An arrow back is an #include between
modules of one stage that closes a cycle.
"""

import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path

TOPS = ("src", "apps", "tests", "docs")
NOT_COUNTED = {".png", ".svg", ".pdf"}
OF_CODE = {".cpp", ".hpp", ".h"}
MOST_FILES = 25
INCLUDE = re.compile(r'^\s*#\s*include\s*"(prostm/[^"]+)"', re.M)


def tracked(root):
    """Returns the tracked files below ROOT, as paths relative to it."""
    listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True, check=True)
    return [Path(line) for line in listed.stdout.splitlines()]


def files_in_folders(files):
    """Returns folder -> number of files directly in it, pictures aside."""
    return Counter(file.parent.as_posix() for file in files
                   if file.parts[0] in TOPS and file.suffix not in NOT_COUNTED)


def modules_of(root, files, stage):
    """Returns module -> the modules of the same stage that it includes. A module is a path without its ending."""
    graph = defaultdict(set)
    prefix = f"src/prostm/{stage}/"
    for file in files:
        if file.suffix in OF_CODE and file.as_posix().startswith(prefix):
            module = file.with_suffix("").as_posix()
            for header in INCLUDE.findall((root / file).read_text(encoding="utf-8")):
                other = "src/" + header.rsplit(".", 1)[0]
                if other.startswith(prefix) and other != module:
                    graph[module].add(other)
            graph[module] |= set()
    return graph


def arrows_back(graph):
    """Returns the includes that close a cycle, as (from, to), found in the order of the names."""
    found, done, path = [], set(), []

    def visit(module):
        path.append(module)
        for other in sorted(graph.get(module, ())):
            if other in path:
                found.append((module, other))
            elif other not in done:
                visit(other)
        done.add(path.pop())

    for module in sorted(graph):
        if module not in done:
            visit(module)
    return found


def stages_of(files):
    return sorted({file.parts[2] for file in files if file.parts[:2] == ("src", "prostm") and len(file.parts) > 3})


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0 if len(sys.argv) == 2 else 2
    root = Path(sys.argv[1]) if len(sys.argv) == 2 else Path(__file__).resolve().parent.parent
    files = tracked(root)
    for folder, count in files_in_folders(files).most_common():
        if count > MOST_FILES:
            print(f"{folder}: {count} files, above {MOST_FILES}")
    code = [file for file in files if file.suffix in OF_CODE and file.parts[0] in TOPS]
    longest = max(code, key=lambda file: (root / file).read_text(encoding="utf-8").count("\n"))
    print(f"longest file: {longest}, {(root / longest).read_text(encoding='utf-8').count(chr(10))} lines")
    for stage in stages_of(files):
        for module, other in arrows_back(modules_of(root, files, stage)):
            print(f"arrow back: {module} -> {other}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
