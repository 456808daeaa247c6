#!/usr/bin/env python3
"""Measures how the sources are laid out: sizes of folders, files and functions, and cyclic includes inside the stages.

usage: house.py [ROOT]     ROOT is a checkout of prostm (default: the folder above this file)

Prints one line for each measure. A module is a header with the sources of its name. An arrow back is an #include
between modules of one stage that closes a cycle. Exits 1 if a folder of src/, apps/, tests/ or docs/ has more than 25
files, not counting pictures, or if device, plan or study has an arrow back.
"""

import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path

from check_lengths import functions

TOPS = ("src", "apps", "tests", "docs")
NOT_COUNTED = {".png", ".svg", ".pdf"}
OF_CODE = {".cpp", ".hpp", ".h"}
MOST_FILES = 25
WITHOUT_ARROWS = ("device", "plan", "study")  # stages that must have none
INCLUDE = re.compile(r'^\s*#\s*include\s*"(prostm/[^"]+)"', re.M)


def tracked(root):
    """Returns the tracked files below ROOT, as paths relative to it."""
    listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True, check=True)
    return [Path(line) for line in listed.stdout.splitlines()]


def files_in_folders(files):
    """Returns folder -> number of files directly in it, not counting pictures."""
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


def longest(root, code):
    """Returns the longest file and the longest function of the sources, as (lines, name)."""
    sources = {file: (root / file).read_text(encoding="utf-8") for file in code}
    file = max((source.count("\n"), path.as_posix()) for path, source in sources.items())
    function = max((count, f"{path}: {name}") for path, source in sources.items() if path.parts[0] in ("src", "apps")
                   for name, _, count in functions(source))
    return file, function


def measure(root):
    """Returns the lines to print, and whether a bound is exceeded."""
    files = tracked(root)
    lines = [f"{folder}: {count} files, above {MOST_FILES}" for folder, count in files_in_folders(files).most_common()
             if count > MOST_FILES]
    broken = bool(lines)
    code = [file for file in files if file.suffix in OF_CODE and file.parts[0] in TOPS]
    for what, (count, name) in zip(("file", "function"), longest(root, code)):
        lines.append(f"longest {what}: {name}, {count} lines")
    for stage in stages_of(files):
        arrows = arrows_back(modules_of(root, files, stage))
        lines += [f"arrow back: {module} -> {other}" for module, other in arrows]
        broken = broken or bool(arrows) and stage in WITHOUT_ARROWS
    return lines, broken


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0 if len(sys.argv) == 2 else 2
    root = Path(sys.argv[1]) if len(sys.argv) == 2 else Path(__file__).resolve().parent.parent
    lines, broken = measure(root)
    print("\n".join(lines))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
