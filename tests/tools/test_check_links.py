"""Tests the check of links: it finds broken links, and accepts valid ones."""

import sys
from functools import partial
from pathlib import Path

import pytest

from checks import check_file

TOOLS = Path(__file__).resolve().parents[2] / "tools"
check_page = partial(check_file, TOOLS / "check_links.py")
sys.path.insert(0, str(TOOLS))
from check_links import anchors_in  # noqa: E402


@pytest.fixture
def tree(tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/other.md").write_text("# One\n\n## Two (2), `three`\n\n## One\n\n```sh\n# no heading\n```\n")
    (tmp_path / "data").mkdir()
    return tmp_path


@pytest.mark.parametrize("text, line", [
    ("see\n[this](missing.md)\n", 2),
    ("![a picture](pictures/missing.png)\n", 1),
    ("[this](other.md#three)\n", 1),
    ("[this](other.md#no-heading)\n", 1),
    ("[this](#nowhere)\n", 1),
    ("[over\ntwo lines](missing.md)\n", 2),
    ("[this](../../outside.md)\n", 1),
    ("[this](/docs/other.md)\n", 1),
    ('[this](missing.md "a title")\n', 1),
    ("\n\n[key]: missing.md\n", 3),
    ('<img src="missing.png">\n', 1),
])
def test_finds_broken_links(tree, text, line):
    status, lines = check_page(tree, "docs/page.md", text)
    assert status == 1
    assert [found.rsplit(":", 1)[0] for found in lines] == [f"docs/page.md:{line}"]


@pytest.mark.parametrize("text", [
    "[this](other.md), [that](other.md#two-2-three), [a folder](../data), [up](../docs/other.md#one-1)\n",
    "# A heading\n\n[here](#a-heading)\n",
    "[far](https://example.org/missing#x), [mail](mailto:a@example.org)\n",
    "`[code](missing.md)` and ``a ` [code](missing.md)``\n",
    "```md\n[code](missing.md)\n```\n",
    "a source [P-1, section 2] (in brackets)\n",
])
def test_accepts_valid_links(tree, text):
    assert check_page(tree, "docs/page.md", text) == (0, [])


@pytest.mark.parametrize("name", ["README.md", "CHANGELOG.md", "docs/a/b/page.md", "data/x/README.md",
                                  "examples/stream/notes.md"])
def test_reads_all_documents(tree, name):
    status, [line] = check_page(tree, name, "[this](missing.md)\n")
    assert status == 1 and line == f"{name}:1: missing.md leads to no file"


def test_headings_have_the_anchors_of_github():
    text = "# What is felt (`felt_weight`, `felt_points`)\n## Pressure\n## Pressure\n### A [link](x.md), *stressed* #\n"
    assert anchors_in(text) == {"what-is-felt-felt_weight-felt_points", "pressure", "pressure-1", "a-link-stressed"}
