"""The documents as rendered: their code blocks."""

from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), ROOT / "data/README.md", *ROOT.glob("docs/**/*.md")])


class Block(NamedTuple):
    """A fenced block: the language after its fence, its text, and the line on which the text begins."""

    language: str
    text: str
    line: int


def name_of(page):
    return str(page.relative_to(ROOT))


def blocks_of(page):
    blocks, inside = [], None
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if not line.lstrip().startswith("```"):
            if inside is not None:
                inside.append(line)
        elif inside is None:
            inside, language, begin = [], line.strip()[3:], number + 1
        else:
            blocks.append(Block(language, "\n".join(inside) + "\n", begin))
            inside = None
    assert inside is None, f"{name_of(page)}: a block of code does not end"
    return blocks


def python_of(page):
    """(code, documented output) of each Python block: the `text` block that follows shows the code's output; code
    without such a block prints nothing."""
    blocks = blocks_of(page)
    return [(block.text, after.text if after and after.language == "text" else "")
            for block, after in zip_longest(blocks, blocks[1:]) if block.language == "python"]
