#!/usr/bin/env python3
"""Lists why tests were skipped, which ctest itself does not print.

usage: skipped_tests.py LOG     LOG is Testing/Temporary/LastTest.log of a build folder

Prints one line for each reason, with the tests: those of GoogleTest and of scripts by their entry in ctest, those of
pytest by file and line. Prints nothing if no test was skipped.
"""

import re
import sys
from pathlib import Path

ENTRY = re.compile(r"^\d+/\d+ Test(?:ing)?: (.+)$")
GOOGLE = re.compile(r"^\S+:\d+: Skipped$")
PLAIN = re.compile(r"^skipped: (.+)$")  # of a script
PYTEST = re.compile(r"^SKIPPED \[\d+\] (\S+:\d+): (.*)$")


def skipped(log):
    """Returns reason -> the tests that were skipped for it, in the order of the log."""
    reasons, entry, lines = {}, "", log.splitlines()
    for i, line in enumerate(lines):
        begun, by_pytest = ENTRY.match(line), PYTEST.match(line)
        if begun:
            entry = begun.group(1)
        elif by_pytest:
            reasons.setdefault(by_pytest.group(2), []).append(by_pytest.group(1))
        elif by_script := PLAIN.match(line):
            reasons.setdefault(by_script.group(1), []).append(entry)
        elif GOOGLE.match(line):
            reason = lines[i + 1].strip() if i + 1 < len(lines) else ""
            reasons.setdefault(reason, []).append(entry)
    return reasons


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    log = Path(sys.argv[1])
    if not log.is_file():
        print(f"skipped_tests: {log} does not exist", file=sys.stderr)
        return 2
    for reason, tests in skipped(log.read_text(encoding="utf-8", errors="replace")).items():
        print(f"skipped: {reason or 'no reason given'}: {', '.join(dict.fromkeys(tests))}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
