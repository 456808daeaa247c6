#!/usr/bin/env python3
"""Checks the labels of equations: each is defined once, in docs/design/, and each cited label is defined.

usage: check_labels.py [ROOT]     ROOT is the repository (default: the folder above this file)

Prints one line for each violation, FILE:LINE: the problem, and exits 1 if there is any.

A label is a capital letter, a number and perhaps a small letter, in round brackets: (P18), (E4a). It is defined by an
item of a list that opens with it, "- (P18) …", in a page of docs/design/. Everything else that looks like a label is a
citation: in comments and strings of the folders CODE, and in the documents. Labels of a page may have gaps, and any
order.
"""

import re
import sys
from pathlib import Path

DESIGN = "docs/design"
CODE = ("src", "apps", "lab", "python", "bench", "examples", "fuzz", "tests", "web/src", "web/tests")
SUFFIXES = (".cpp", ".hpp", ".py", ".pyi", ".ts")
DOCUMENTS = ("*.md", "docs/**/*.md", "data/**/*.md")
# these must name labels that do not exist
LISTS = ("tests/tools/test_check_labels.py",)
LABEL = re.compile(r"\(([A-Z]\d{1,2}[a-z]?)\)")
DEFINITION = re.compile(r"^\s*[-*] " + LABEL.pattern)


def definitions_in(root):
    """{label: [(file, line), …]} of docs/design/."""
    found = {}
    for page in sorted((root / DESIGN).glob("*.md")):
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            if definition := DEFINITION.match(line):
                found.setdefault(definition[1], []).append((page.relative_to(root).as_posix(), number))
    return found


def texts_in(root):
    """(name, text) of all files that may cite a label."""
    files = {path for pattern in DOCUMENTS for path in root.glob(pattern)}
    for folder in CODE:
        files |= {path for path in (root / folder).rglob("*") if path.suffix in SUFFIXES and path.is_file()}
    for path in sorted(files):
        name = path.relative_to(root).as_posix()
        if name not in LISTS:
            yield name, path.read_text(encoding="utf-8")


def problems(root):
    defined = definitions_in(root)
    for label, places in defined.items():
        for name, number in places[1:]:
            yield f"{name}:{number}: ({label}) is defined in {places[0][0]}:{places[0][1]}, too"
    for name, text in texts_in(root):
        for number, line in enumerate(text.splitlines(), 1):
            for label in LABEL.findall(line):
                if label not in defined:
                    yield f"{name}:{number}: ({label}) is defined nowhere in {DESIGN}"


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1]
    found = list(problems(root))
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
