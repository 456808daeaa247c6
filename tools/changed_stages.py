#!/usr/bin/env python3
"""Prints the stages whose sanitizers and fuzzers a change asks for, one a line; nothing means all of them.

usage: changed_stages.py COMMIT

COMMIT is one whose whole run passed. A stage is a folder of src/prostm/ or tests/. pipeline, viewer and app (the command line)
are always among them. All are asked for when COMMIT is no ancestor of HEAD, or when a file has changed that belongs to no
stage and is built or run with all: CMake's files, the scripts, what tests share.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ALWAYS = {"pipeline", "viewer", "app"}
# what no sanitizer or fuzzer looks at
ELSEWHERE = ("docs", "web", "bench", "lab", "examples", "python", "README.md", "CHANGELOG.md", "LICENSE", ".ci", ".gitignore")


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True)


def stage_of(path):
    """The stage of a changed file; "" for one that is none's and matters to none, None for one that matters to all."""
    parts = Path(path).parts
    if parts[:2] == ("tests", "fields") or parts[:3] == ("src", "prostm", "textbook"):
        return None  # tests of several stages link them
    if parts[0] in ELSEWHERE:
        return ""
    if parts[0] == "apps" or parts[:2] == ("tests", "command_line"):
        return "app"
    folder = parts[2:] if parts[:2] == ("src", "prostm") else parts[1:] if parts[0] == "tests" else ()
    if len(folder) > 1 and (ROOT / "src/prostm" / folder[0]).is_dir():
        return folder[0]
    if parts[:2] in (("tests", "python"), ("tests", "lab"), ("tests", "library")):
        return ""
    return None


def changed_stages(since):
    if not since or git("merge-base", "--is-ancestor", since, "HEAD").returncode != 0:
        return set()
    files = git("diff", "--name-only", since).stdout.splitlines()
    files += git("ls-files", "--others", "--exclude-standard").stdout.splitlines()
    stages = {stage_of(path) for path in files}
    return set() if None in stages else stages - {""} | ALWAYS


def main():
    if len(sys.argv) != 2:
        print("changed_stages: give one commit; see its first lines", file=sys.stderr)
        return 2
    for stage in sorted(changed_stages(sys.argv[1])):
        print(stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
