"""The names that a program or a static library defines, and names that nothing shipped may define."""

import re
import subprocess

# the lab and benchmarks, GoogleTest, and the folders of tests; not the namespaces test inside other libraries
FOREIGN = re.compile(r"\bprostm::(?:bench|test|tests)::|(?<![\w:])(?:testing|test)::"
                     r"|\bprint_and_write\(|\bcompare_ways\(")


def foreign(names):
    """Returns the demangled names that belong to the lab, benchmarks or tests."""
    return [name for name in names if FOREIGN.search(name)]


def defined(file):
    """Returns the demangled names that a program or library defines."""
    lines = subprocess.run(["nm", "-C", "--defined-only", file], capture_output=True, text=True, check=True).stdout
    matches = (re.match(r"[0-9a-f]+ \w (.*)", line) for line in lines.splitlines())
    return [match.group(1) for match in matches if match]
