#!/usr/bin/env python3
"""Prints the stages whose sanitizers and fuzzers a change needs, one per line; no output means all stages.

usage: changed_stages.py COMMIT

COMMIT must have passed a whole run. A stage is a folder of src/prostm/ or tests/. pipeline, viewer and app (the command
line) are always printed. All stages are needed if COMMIT is no ancestor of HEAD, or if a changed file belongs to no
stage and is built or run with all of them: CMake's files, the scripts, the shared parts of tests.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ALWAYS = {"pipeline", "viewer", "app"}
# stages that the tests of several others link
SHARED = (("src", "prostm", "textbook"), ("src", "prostm", "fields"))
# stand-ins that tests of devices run against
DEVICE_SUPPORT = (("tests", "support", "standins"), ("tests", "support", "ultraleap_sdk"))
# files that no sanitizer or fuzzer covers
ELSEWHERE = ("docs", "web", "bench", "lab", "examples", "python", "README.md", "CHANGELOG.md", "CONTRIBUTING.md",
             "SECURITY.md", "CITATION.cff", "LICENSE", ".ci", ".github", ".gitignore", ".vale.ini", ".codespellrc",
             ".pre-commit-config.yaml")


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True)


def stage_of(path):
    """Returns the stage of a changed file; "" for a file that affects no stage, None for one that affects all."""
    parts = Path(path).parts
    if parts[:3] in SHARED:
        return None
    if parts[0] in ELSEWHERE:
        return ""
    if parts[0] == "apps" or parts[:2] == ("tests", "command_line"):
        return "app"
    folder = parts[2:] if parts[:2] == ("src", "prostm") else parts[1:] if parts[0] == "tests" else ()
    if len(folder) > 1 and (ROOT / "src/prostm" / folder[0]).is_dir():
        return folder[0]
    if parts[:2] in (("tests", "python"), ("tests", "lab"), ("tests", "library"), ("tests", "symbols"),
                     ("tests", "tools")):
        return ""
    if parts[:2] == ("tests", "ultraleap") or parts[:3] in DEVICE_SUPPORT:
        return "device"
    return None


def changed_stages(since):
    if not since or git("merge-base", "--is-ancestor", since, "HEAD").returncode != 0:
        return set()
    files = git("diff", "--name-only", since).stdout.splitlines()
    files += git("ls-files", "--others", "--exclude-standard").stdout.splitlines()
    stages = {stage_of(path) for path in files}
    if None in stages:
        return set()
    if "device" in stages:
        stages.add("ultraleap")  # an adapter of the device's stage has a test program of its own
    return stages - {""} | ALWAYS


def main():
    if len(sys.argv) != 2:
        print("usage: changed_stages.py COMMIT", file=sys.stderr)
        return 2
    for stage in sorted(changed_stages(sys.argv[1])):
        print(stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
