"""Tests the check of labels: it finds labels that are defined twice, or cited without a definition."""

import re
import shutil
from functools import partial
from pathlib import Path

import pytest

from checks import check, check_file

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "check_labels.py"
check_with = partial(check_file, TOOL)


@pytest.fixture
def tree(tmp_path):
    (tmp_path / "docs/design").mkdir(parents=True)
    (tmp_path / "docs/design/index.md").write_text("# Design\n\n- (M1) c = 1\n- (M4a) d = 2, by (M1)\n  (M1) again\n")
    return tmp_path


@pytest.mark.parametrize("name, text", [
    ("src/prostm/plan/a.hpp", "\n/// See (M2) of docs/design/index.md.\n"),
    ("apps/prostm/a.cpp", '\nsay("by (M1), (M2)");\n'),
    ("lab/a.hpp", "\n// (M4b)\n"),
    ("python/a.pyi", '\n"""(M2)"""\n'),
    ("web/src/a.ts", "\n/// (M2)\n"),
    ("docs/guides/a.md", "\n(M1) to (M5) of design\n"),
    ("docs/guides/a.md", "\n- (M2) is defined in no page of the design\n"),
])
def test_finds_labels_without_a_definition(tree, name, text):
    status, [line] = check_with(tree, name, text)
    assert status == 1 and line.startswith(f"{name}:2: (M") and line.endswith("is defined nowhere in docs/design")


def test_finds_a_label_that_is_defined_twice(tree):
    status, lines = check_with(tree, "docs/design/other.md", "# Other\n\n- (M1) c = 3\n")
    assert status == 1
    assert lines == ["docs/design/other.md:3: (M1) is defined in docs/design/index.md:3, too"]


@pytest.mark.parametrize("text", [
    "/// (M1) and (M4a).\n",
    "f(A), f(M), (a1), (MM1), [M1], (M123)\n",
])
def test_ignores_other_text(tree, text):
    assert check_with(tree, "src/prostm/plan/a.hpp", text) == (0, [])


def test_detects_a_label_removed_from_the_design(tmp_path):
    shutil.copytree(ROOT / "docs/design", tmp_path / "docs/design")
    shutil.copytree(ROOT / "src", tmp_path / "src")
    assert check(TOOL, tmp_path) == (0, [])
    page = tmp_path / "docs/design/acoustics.md"
    text = page.read_text()
    page.write_text(re.sub(r"^- \(A22\) ", "- ", text, flags=re.MULTILINE))
    assert page.read_text() != text
    status, lines = check(TOOL, tmp_path)
    assert status == 1 and lines
    assert all(line.endswith("(A22) is defined nowhere in docs/design") for line in lines)
