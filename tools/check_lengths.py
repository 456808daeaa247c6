#!/usr/bin/env python3
"""Limits files of src/ and apps/ to 450 lines and their functions to 60.

usage: check_lengths.py [ROOT]     ROOT is the repository (default: the folder above this file)

Prints one line for each that is longer, FILE:LINE: its length and the limit, and exits 1 if there is any. A function
counts from the line where its declaration begins to that of its last brace, including its lambdas. Data in braces does
not count.
"""

import re
import sys
from pathlib import Path

from check_layers import without_text

MOST_FILE_LINES = 450
MOST_FUNCTION_LINES = 60

DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.M)
SCOPE = re.compile(r"\b(?:namespace|struct|class|union|enum)\b|\bextern\s*$")
ACCESS = re.compile(r"\b(?:public|private|protected)\s*\Z")
NAME = re.compile(r"((?:[\w:]|<[^<>]*>)*(?:operator\s*(?:\(\)|[^\s\w(]+)|~?\b\w+))\s*\($")


def without_arguments(header):
    """Returns the header without the contents of round brackets, and without its template<…>."""
    header = re.sub(r"\boperator\s*(?:\(\)|[^\s\w(]+)", "operator_", header)
    while True:
        shorter = re.sub(r"\([^()]*\)", "\0", header)
        if shorter == header:
            break
        header = shorter
    depth, end = 0, 0
    if re.match(r"\s*template\b", header):
        for end, character in enumerate(header):
            depth += (character == "<") - (character == ">")
            if character == ">" and depth == 0:
                break
        header = header[end + 1:]
    return header


def kind_of(header):
    """Returns the kind of a brace in a namespace or class, by the header before it: scope, member (of a constructor's
    list), function, or data."""
    bare = without_arguments(header)
    if SCOPE.search(bare) and not bare.rstrip().endswith("\0"):
        return "scope"
    if "=" in bare or "\0" not in bare:
        return "data"
    if re.search(r"\0[\w\s]*:(?!:)(?:.*,)?\s*[\w:<>, ]+$", bare, re.S):
        return "member"
    return "function"


def name_of(header):
    """Returns the name in a function's header: the words before its first round bracket that is not a specifier's."""
    for bracket in re.finditer(r"\(", header):
        name = NAME.search(header[:bracket.end()])
        if name and not name.group(1).endswith(("alignas", "decltype", "requires", "operator")):
            return name.group(1)
    return header.strip().split("\n")[0]


def functions(source):
    """Returns (name, first line, number of lines) of each function defined in a namespace or class."""
    text = DIRECTIVE.sub(lambda m: "\n" * m.group(0).count("\n"), without_text(source))
    found, scopes, start, position = [], [], 0, 0
    while position < len(text):
        character = text[position]
        if character == ";" or character == ":" and ACCESS.search(text, start, position):
            start = position + 1
        elif character == "}":
            if scopes:
                scopes.pop()
            start = position + 1
        elif character == "{":
            header = text[start:position]
            kind = kind_of(header)
            if kind == "scope":
                scopes.append(position)
                start = position + 1
            else:
                end = closing(text, position)
                if kind == "function":
                    begin = start + len(header) - len(header.lstrip())
                    first = text.count("\n", 0, begin) + 1
                    found.append((name_of(header), first, text.count("\n", begin, end) + 1))
                if kind == "function":
                    start = end + 1
                position = end
        position += 1
    return found


def closing(text, position):
    """Returns the position where the brace at position is closed."""
    depth = 0
    for brace in re.finditer(r"[{}]", text[position:]):
        depth += 1 if brace.group(0) == "{" else -1
        if depth == 0:
            return position + brace.start()
    return len(text)


def check_tree(root):
    """Returns all excess lengths below root, as 'file:line: message'."""
    lines = []
    for top in ("src", "apps"):
        for file in sorted((root / top).rglob("*.?pp")):
            path = file.relative_to(root).as_posix()
            source = file.read_text(encoding="utf-8")
            length = source.count("\n")
            if length > MOST_FILE_LINES:
                lines.append(f"{path}:1: {length} lines: at most {MOST_FILE_LINES}")
            for name, first, count in functions(source):
                if count > MOST_FUNCTION_LINES:
                    lines.append(f"{path}:{first}: {name} has {count} lines: at most {MOST_FUNCTION_LINES}")
    return lines


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0 if len(sys.argv) == 2 else 2
    root = Path(sys.argv[1]) if len(sys.argv) == 2 else Path(__file__).resolve().parent.parent
    if not (root / "src").is_dir():
        print(f"check_lengths: {root} has no src", file=sys.stderr)
        return 2
    lines = check_tree(root)
    for line in lines:
        print(line)
    if not lines:
        print(f"lengths: files have at most {MOST_FILE_LINES} lines, functions at most {MOST_FUNCTION_LINES}")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
