#!/usr/bin/env python3
"""Holds texts to plain English: lists the places that fall back into the old idiom, and lines of documents that are too
long.

usage: check_words.py FOLDER

FOLDER is a checkout. Exit status 1 when anything is listed.
"""

import re
import sys
from pathlib import Path

LONGEST = 120
FOLDERS = ("apps", "bench", "cmake", "data", "docs", "examples", "fuzz", "lab", "python", "src", "tests", "tools",
           "web/src", "web/tests")
DOCUMENTS = (".md",)
SOURCES = (".cpp", ".hpp", ".py", ".pyi", ".sh", ".ts", ".txt", ".cmake", "run")
# this list, and what tests it, must name what they forbid
LISTS = ("tools/check_words.py", "tests/tools/test_check_words.py")

IDIOM = {
    re.compile(r"\b(?:is|are) none\b"): "say what is missing: 'there is no …'",
    re.compile(r"\bis one(?=[.,;:)\"]|$| (?:that|which|who)\b)"): "name the thing in place of 'one'",
    re.compile(r"\bfor ever\b"): "'without end', 'never'",
    re.compile(r"\bof no meaning\b"): "'unspecified'",
}
# as comments, documents and messages had them, white space and emphasis aside
SENTENCES = (
    "Use my mouse as the hand is one",
    "which has been tried against stand-ins that replay recordings, and never with a real one",
    "nothing else has to be there but git",
    "What cannot be is answered with a sentence",
    "A frame that cannot be is dropped",
    "A pose file comes of a calibration",
    "hands are taken to be where they will be so much later",
    "takes the place of one that the frame does not have",
    "with one corner of its own sign",
    "the output fades, for the depth of the queue and the time of the fade",
    "a test that uses data which is not part of the project says so",
    "It is printed and judges nothing",
    "What the smoke's stage is built from",
    "itself where it is alone",
    "Of a focal point that sounds",
    "What is in it before is of no meaning",
    "No hand, for ever",
    "is none; give one like",
    "by way of int, for which the machine has an instruction",
    "for an id that is none",
    "share of a cost that is none",
    "the one sentence that refuses what lies outside them",
)
# a comment's or docstring's first line
OPENING = re.compile(r'^\s*(?:///?<?|#|""")\s*(Of|What)\b')
TRAILING = re.compile(r"\S.*?\s(?:///<?|//|#)\s+(Of|What)\b")
COMMENT = re.compile(r"^\s*(?://|#(?!include|pragma|if|endif|else|define))")


def plain(text):
    """Without the marks of comments and emphasis, in single spaces."""
    return re.sub(r"[\s*_]+", " ", re.sub(r"^\s*(?:///?<?|#)", "", text, flags=re.MULTILINE))


def idiom_in(text):
    """(line, what is wrong) of each place."""
    for number, line in enumerate(text.splitlines(), 1):
        for pattern, better in IDIOM.items():
            if found := pattern.search(line):
                yield number, f'"{found[0]}": {better}'


def sentences_in(text):
    flat = plain(text)
    for sentence in SENTENCES:
        if sentence in flat:
            yield 1, f'the old sentence "{sentence}"'


def openings_in(text):
    """Comments that open with Of or What."""
    before = ""
    for number, line in enumerate(text.splitlines(), 1):
        first = OPENING.match(line) if not COMMENT.match(before) or '"""' in line else None
        if found := first or (None if COMMENT.match(line) else TRAILING.match(line)):
            yield number, f'a comment opens with "{found[1]}": begin with a verb or a noun'
        before = line


def long_lines_in(text):
    """Lines above LONGEST columns that are neither of a table, nor a link, nor code."""
    code = False
    for number, line in enumerate(text.splitlines(), 1):
        code ^= line.startswith("```")
        link = re.fullmatch(r"\s*[-*]?\s*!?\[[^]]*\]\([^)]*\)[.,;]?", line)
        if len(line) > LONGEST and not (code or link or line.lstrip().startswith("|")):
            yield number, f"{len(line)} columns, above {LONGEST}"


def texts_in(root):
    """(name, path) of each file that is written by hand."""
    files = [path for path in root.iterdir() if path.is_file()]
    for folder in FOLDERS:
        files += (path for path in (root / folder).rglob("*") if path.is_file())
    for path in sorted(files):
        name = path.relative_to(root).as_posix()
        if name.endswith(DOCUMENTS + SOURCES) and name not in LISTS:
            yield name, path


def problems(root):
    for name, path in texts_in(root):
        text = path.read_text(encoding="utf-8")
        checks = (idiom_in, sentences_in, long_lines_in if name.endswith(DOCUMENTS) else openings_in)
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
