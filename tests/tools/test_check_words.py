"""The check of words itself: it finds the old idiom, and leaves plain English alone."""

from functools import partial
from pathlib import Path

import pytest

from checks import check_file

check = partial(check_file, Path(__file__).resolve().parents[2] / "tools" / "check_words.py")


@pytest.mark.parametrize("name, text", [
    ("src/prostm/plan/a.hpp", "/// Of a path [m].\ndouble length;\n"),
    ("src/prostm/plan/a.hpp", "double length;  ///< of a path\nint n;  // What is left.\n"),
    ("src/prostm/plan/a.cpp", 'throw InputError("the id is none");\n'),
    ("tools/a.py", '"""What it does."""\n'),
    ("web/src/a.ts", "// there are none\n"),
    ("run", "# It runs for ever.\n"),
    ("README.md", "A hand that is one.\n"),
    ("docs/a.md", "Its earlier contents are of no meaning.\n"),
    ("docs/a.md", "It is *printed\nand* judges nothing\n"),
    ("docs/experiments/a.md", "x" * 121 + "\n"),
])
def test_finds_the_old_idiom(tmp_path, name, text):
    status, lines = check(tmp_path, name, text)
    assert status == 1
    assert [line.split(":")[0] for line in lines] == [name]


@pytest.mark.parametrize("name, text", [
    ("src/prostm/plan/a.hpp", "/// Length of a path,\n/// What follows stands in the same comment.\ndouble length;\n"),
    ("src/prostm/plan/a.cpp", "bool is_one = false;  // whether there is one focal point\n#include <x>\n"),
    ("docs/a.md", "It is one of three. It is one path.\n| " + "x" * 130 + " |\n"),
    ("docs/a.md", "```sh\n" + "x" * 130 + "\n```\n![" + "x" * 130 + "](a.png)\n"),
    ("web/node_modules/a/README.md", "x" * 130 + "\n"),
    ("build/release/a.md", "x" * 130 + "\n"),
])
def test_leaves_plain_english_alone(tmp_path, name, text):
    assert check(tmp_path, name, text) == (0, [])
