#!/usr/bin/env python3
"""Checks texts for plain English: lists places that break the rules of wording, and lines of documents that are too
long.

usage: check_words.py FOLDER

FOLDER is a checkout. The rules of wording are those of tools/vale/prostm, which tools/check_prose.sh gives to Vale;
needs Python's yaml. Exit status 1 when anything is listed.
"""

import re
import sys
from pathlib import Path

from vale_rules import read_rules

LONGEST = 120
FOLDERS = ("apps", "bench", "cmake", "data", "docs", "examples", "fuzz", "lab", "python", "src", "tests", "tools",
           "web/src", "web/tests")
DOCUMENTS = (".md",)
SOURCES = (".cpp", ".hpp", ".py", ".pyi", ".sh", ".ts", ".txt", ".cmake", "run")
# this script and its test must contain the forbidden words
LISTS = ("tools/check_words.py", "tests/tools/test_check_words.py")
RULES = Path(__file__).resolve().parent / "vale" / "prostm"

# a comment's or docstring's first line
OPENING = re.compile(r'^\s*(?:///?<?|#|""")\s*(Of|What)\b')
TRAILING = re.compile(r"\S.*?\s(?:///<?|//|#)\s+(Of|What)\b")
COMMENT = re.compile(r"^\s*(?://|#(?!include|pragma|if|endif|else|define))")


def openings_in(text):
    """Finds comments that open with Of or What."""
    before = ""
    for number, line in enumerate(text.splitlines(), 1):
        first = OPENING.match(line) if not COMMENT.match(before) or '"""' in line else None
        if found := first or (None if COMMENT.match(line) else TRAILING.match(line)):
            yield number, f'a comment opens with "{found[1]}": begin with a verb or a noun'
        before = line


def long_lines_in(text):
    """Finds lines above LONGEST columns that are not part of a table, a link or code."""
    code = False
    for number, line in enumerate(text.splitlines(), 1):
        code ^= line.startswith("```")
        link = re.fullmatch(r"\s*[-*]?\s*!?\[[^]]*\]\([^)]*\)[.,;]?", line)
        if len(line) > LONGEST and not (code or link or line.lstrip().startswith("|")):
            yield number, f"{len(line)} columns, above {LONGEST}"


def texts_in(root):
    """Finds (name, path) of each file that is written by hand."""
    files = [path for path in root.iterdir() if path.is_file()]
    for folder in FOLDERS:
        files += (path for path in (root / folder).rglob("*") if path.is_file())
    for path in sorted(files):
        name = path.relative_to(root).as_posix()
        if name.endswith(DOCUMENTS + SOURCES) and name not in LISTS:
            yield name, path


def problems(root):
    rules = read_rules(RULES)
    for name, path in texts_in(root):
        text = path.read_text(encoding="utf-8")
        checks = [rule.places for rule in rules] + [long_lines_in if name.endswith(DOCUMENTS) else openings_in]
        for number, what in sorted(place for check in checks for place in check(text)):
            yield f"{name}:{number}: {what}"


def main():
    if len(sys.argv) != 2:
        print("check_words: give a checkout; see its first lines", file=sys.stderr)
        return 2
    found = list(problems(Path(sys.argv[1])))
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
