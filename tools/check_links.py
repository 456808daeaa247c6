#!/usr/bin/env python3
"""Checks that each relative link in the documents leads to a file or folder, and its anchor to a heading.

usage: check_links.py [ROOT]     ROOT is the repository (default: the folder above this file)

Prints one line for each violation, FILE:LINE: the problem, and exits 1 if there is any. Documents are those of PAGES.
Code is left out, and so are links with a scheme, such as https: nothing is fetched.
"""

import re
import sys
from pathlib import Path
from urllib.parse import unquote

PAGES = ("*.md", "docs/**/*.md", "data/**/README*.md", "examples/**/*.md")
# [text](target), also with a title; [key]: target; and the two attributes of HTML
LINK = re.compile(r'\]\(\s*<?([^)\s>]+)>?(?:\s+"[^"]*")?\s*\)|^\s{0,3}\[[^]]+\]:\s+(\S+)|\b(?:src|href)="([^"]+)"',
                  re.MULTILINE)
SCHEME = re.compile(r"[a-z][a-z0-9+.-]*:|//", re.IGNORECASE)
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)(?:\s+#+)?\s*$")
ANCHOR = re.compile(r'<a\s[^>]*\b(?:id|name)="([^"]+)"')


def without_fences(text):
    """Returns the text with fenced blocks of code blanked out, lines kept."""
    lines, fence = [], None
    for line in text.splitlines():
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and fence is None:
            fence = mark[1][:3]
        elif mark and mark[1].startswith(fence):
            fence = None
        elif fence is None:
            lines.append(line)
            continue
        lines.append("")
    return "\n".join(lines)


def without_code(text):
    """Returns the same with inline code blanked out too, columns kept."""
    return re.sub(r"(`+)(?!`)[^\n]*?(?<!`)\1(?!`)", lambda code: " " * len(code[0]), without_fences(text))


def slug_of(heading):
    """Returns GitHub's anchor of a heading: in small letters, without punctuation, with - for each space."""
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")


def anchors_in(text):
    """Returns the anchors of a page; a repeated heading gets -1, -2, …"""
    anchors, times = set(ANCHOR.findall(text)), {}
    for line in without_fences(text).splitlines():
        if heading := HEADING.match(line):
            slug = slug_of(heading[1])
            again = times.get(slug, 0)
            times[slug] = again + 1
            anchors.add(f"{slug}-{again}" if again else slug)
    return anchors


def links_in(text):
    """Returns (line, target) of each link."""
    plain = without_code(text)
    for link in LINK.finditer(plain):
        target = link[1] or link[2] or link[3]
        yield plain.count("\n", 0, link.start() + len(link[0]) - len(link[0].lstrip())) + 1, target


def problem_of(target, page, root):
    """Returns the problem of a link of a page, or None."""
    if SCHEME.match(target):
        return None
    path, _, anchor = unquote(target).partition("#")
    place = (page.parent / path).resolve() if path else page.resolve()
    if not place.is_relative_to(root.resolve()):
        return f"{target} leads out of the repository"
    if not place.exists():
        return f"{target} leads to no file"
    if anchor and place.suffix == ".md" and anchor not in anchors_in(place.read_text(encoding="utf-8")):
        return f"{target} leads to no heading"
    return None


def problems(root):
    for page in sorted({page for pattern in PAGES for page in root.glob(pattern)}):
        for line, target in links_in(page.read_text(encoding="utf-8")):
            if problem := problem_of(target, page, root):
                yield f"{page.relative_to(root).as_posix()}:{line}: {problem}"


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1]
    found = list(problems(root))
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
