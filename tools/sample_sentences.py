#!/usr/bin/env python3
"""Prints sentences chosen at random from documents, comments of headers, and messages, for a reading test.

usage: sample_sentences.py [--seed SEED] [--count COUNT]

COUNT (default 20) sentences are drawn in equal parts from the three kinds. The same seed and sources give the same
sentences. docs/measurements/sentences.md lists such a sample, and is not itself drawn from.
"""

import argparse
import random
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SAMPLE = ROOT / "docs/measurements/sentences.md"
LEAST_WORDS = 6
SENTENCE_END = re.compile(r"(?<=[.:!?])\s+(?=[A-Z`\"(])")


def sentences_of(text):
    for sentence in SENTENCE_END.split(" ".join(text.split())):
        if len(sentence.split()) >= LEAST_WORDS and not sentence.startswith("<"):
            yield sentence


def paragraphs_of(text):
    """The paragraphs and list items of a document, without code, tables, headings and pictures."""
    text = re.sub(r"^\s*(```|~~~).*?^\s*\1\s*$", "", text, flags=re.M | re.S)
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        if not re.match(r"\s*(?:\||#|!|<|\$\$|\[)", paragraph):
            yield re.sub(r"^\s*(?:[-*>]|\d+\.) ", "", paragraph)


def documents():
    for path in sorted({*ROOT.glob("docs/**/*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"} - {SAMPLE}):
        for paragraph in paragraphs_of(path.read_text()):
            yield path, paragraph


def comments():
    for path in sorted(ROOT.glob("src/prostm/**/*.hpp")):
        for block in re.findall(r"(?:^\s*/// [^\n]*\n)+", path.read_text(), flags=re.M):
            yield path, " ".join(line.strip()[4:] for line in block.splitlines())


def messages():
    literal = r'"(?:[^"\\\n]|\\.)*"'
    for path in sorted([*ROOT.glob("src/prostm/**/*.cpp"), *ROOT.glob("apps/**/*.cpp")]):
        code = "\n".join(line for line in path.read_text().splitlines() if not line.lstrip().startswith(("//", "#")))
        for run in re.findall(rf"{literal}(?:\s*{literal})*", code):
            yield path, "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', run)).replace(r"\"", '"').replace(r"\n", " ")


def sample(seed, count):
    """[(kind, path, sentence)], an equal number of each kind."""
    choose = random.Random(seed)
    out = []
    for rank, (kind, texts) in enumerate((("document", documents), ("comment", comments), ("message", messages))):
        all_of_kind = [(kind, path.relative_to(ROOT), s) for path, text in texts() for s in sentences_of(text)]
        out += choose.sample(all_of_kind, (count + rank) // 3)
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    options = parser.parse_args()
    for kind, path, sentence in sample(options.seed, options.count):
        print(f"{kind}\t{path}\t{sentence}")


if __name__ == "__main__":
    main()
