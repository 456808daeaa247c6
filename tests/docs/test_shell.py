"""That the comparison of outputs sees what it is there to see."""

import pytest
from shell import check_output, same_line, shortened, split_commands


def test_numbers_may_differ_by_a_tenth_and_words_by_nothing():
    assert same_line("rmse 0.063, 4 paths", "rmse 0.060, 4 paths")
    assert not same_line("rmse 0.063, 4 paths", "rmse 0.160, 4 paths")
    assert not same_line("rmse 0.063, 4 paths", "rmse 0.063, 5 paths")
    assert not same_line("rmse 0.063", "correlation 0.063")
    assert same_line("planned in … ms", "planned in 12.40 ms")


def test_lines_come_in_their_order():
    printed = "one\ntwo\nthree\n"
    check_output("one\n…\nthree\n", printed)
    check_output("…\ntwo\n", printed)
    with pytest.raises(AssertionError, match="printed: two"):
        check_output("one\nthree\n", printed)
    with pytest.raises(AssertionError, match="never printed"):
        check_output("…\nfour\n", printed)


def test_commands_are_split_where_the_shell_ends_them():
    text = "one \\\n  --more\n# a comment\ncat > x <<'END'\na = 1\nEND\ntwo\n"
    assert list(split_commands(text)) == ["one \\\n  --more", "cat > x <<'END'\na = 1\nEND", "two"]


def test_only_runs_by_the_clock_are_cut_short():
    assert shortened("prostm run --seconds 60") == "prostm run --seconds 2"
    assert shortened("prostm run --view") == "prostm run --view --seconds 2 --view-port 0"
    assert shortened("prostm run --stepped --seconds 9") == "prostm run --stepped --seconds 9"
    assert shortened("prostm plan x.npy") == "prostm plan x.npy"
