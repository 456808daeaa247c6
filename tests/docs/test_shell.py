"""Checks that the comparison of outputs detects differences."""

import pytest
from pages import Block, python_of
from shell import check_output, commands_of, same_line, shortened, split_commands


def test_numbers_may_differ_by_a_tenth_and_words_not_at_all():
    assert same_line("rmse 0.063, 4 paths", "rmse 0.060, 4 paths")
    assert not same_line("rmse 0.063, 4 paths", "rmse 0.160, 4 paths")
    assert not same_line("rmse 0.063, 4 paths", "rmse 0.063, 5 paths")
    assert not same_line("rmse 0.063", "rmse 0.071")
    assert not same_line("rmse 0.063", "correlation 0.063")
    assert same_line("planned in … ms", "planned in 12.40 ms")
    assert same_line("rmse=0.063…)", "rmse=0.06308852129386783)")


def test_a_number_near_0_may_change_its_sign_and_its_width():
    assert same_line("flat field   0.000  1", "flat field  -0.000  1")
    assert not same_line("flat field   0.000  1", "flat field   0.002  1")


def test_lines_must_be_in_order():
    printed = "one\ntwo\nthree\n"
    check_output("one\n…\nthree\n", printed)
    check_output("…\ntwo\n…\n", printed)
    with pytest.raises(AssertionError, match="printed: two"):
        check_output("one\nthree\n", printed)
    with pytest.raises(AssertionError, match="never printed"):
        check_output("…\nfour\n", printed)


def test_all_output_is_shown_or_covered_by_a_line_of_dots():
    check_output("one\n…\n", "one\ntwo\n")
    check_output("…\n", "")
    with pytest.raises(AssertionError, match="not shown: two"):
        check_output("one\n", "one\ntwo\n")
    with pytest.raises(AssertionError, match="not shown: one"):
        check_output("", "one\n")


def test_a_console_block_holds_commands_and_their_output():
    console = Block("console", "$ one \\\n    --more\nprinted\n\n$ two\n", 1)
    assert list(commands_of(console)) == [("one \\\n    --more", "printed\n\n"), ("two", "")]
    assert list(commands_of(Block("sh", "one\n", 1))) == [("one", None)]
    assert not list(commands_of(Block("text", "$ one\n", 1)))
    with pytest.raises(AssertionError, match="begins with"):
        list(commands_of(Block("console", "one\n$ two\n", 1)))


def test_the_text_after_python_is_its_output(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("```text\nx\n```\n```python\na = 1\n```\n```python\nprint(a)\n```\nprints\n```text\n1\n```\n")
    assert python_of(page) == [("a = 1\n", ""), ("print(a)\n", "1\n")]


def test_commands_are_split_where_the_shell_ends_them():
    text = "one \\\n  --more\n# a comment\ncat > x <<'END'\na = 1\nEND\ntwo\n"
    assert list(split_commands(text)) == ["one \\\n  --more", "cat > x <<'END'\na = 1\nEND", "two"]


def test_only_real_time_runs_are_shortened():
    assert shortened("prostm run --seconds 60") == "prostm run --seconds 3"
    assert shortened("prostm run --view") == "prostm run --view --seconds 3"
    assert shortened("prostm run --stepped --seconds 9") == "prostm run --stepped --seconds 9"
    assert shortened("prostm plan x.npy") == "prostm plan x.npy"
