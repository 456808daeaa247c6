"""Tests the check of words: it finds the old idiom, accepts plain English, and reads the rules of Vale."""

import sys
from functools import partial
from pathlib import Path

import pytest

from checks import check_file

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from vale_rules import read_rules  # noqa: E402

check = partial(check_file, TOOLS / "check_words.py")


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
    ("docs/a.md", "It is printed and\n_judges_ nothing\n"),
    ("src/prostm/plan/a.hpp", "/// A point for\n/// ever.\nint n;\n"),
    ("docs/a.md", "In order to plan, it needs a field.\n"),
    ("docs/a.md", "A powerful planner.\n"),
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
    ("src/prostm/plan/a.cpp", "if (a.is_none()) return;\n"),
    ("web/node_modules/a/README.md", "x" * 130 + "\n"),
    ("build/release/a.md", "x" * 130 + "\n"),
])
def test_accepts_plain_english(tmp_path, name, text):
    assert check(tmp_path, name, text) == (0, [])


RULE = "extends: existence\nmessage: \"'%s' is old\"\nlevel: error\n"


def test_a_rule_names_its_line_and_the_better_word(tmp_path):
    (tmp_path / "a.yml").write_text("extends: substitution\nmessage: \"'%s', not '%s'\"\nlevel: error\n"
                                    "ignorecase: true\nswap:\n  old word: new word\n")
    (rule,) = read_rules(tmp_path)
    assert list(rule.places("One.\nAn Old\nword.\n")) == [(2, "'new word', not 'Old word'")]
    assert list(rule.places("old words, bold word")) == []


@pytest.mark.parametrize("text, says", [
    (RULE + "tokens: [a]\nscope: heading\n", "no key 'scope'"),
    (RULE.replace("existence", "spelling") + "tokens: [a]\n", "no rule 'spelling'"),
])
def test_an_unsupported_rule_is_an_error(tmp_path, text, says):
    (tmp_path / "a.yml").write_text(text)
    with pytest.raises(ValueError, match=says):
        read_rules(tmp_path)


def test_a_folder_without_rules_is_an_error(tmp_path):
    with pytest.raises(ValueError, match="has no rules"):
        read_rules(tmp_path)
