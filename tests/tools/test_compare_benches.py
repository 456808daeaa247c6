"""The comparison of benchmarks: it finds slower rows, and does not mistake noise for them."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools" / "compare_benches.py"

# A benchmark that takes its next times from a list in each run, cyclically.
BENCH = """#!{python}
import json, pathlib, sys
count = pathlib.Path(__file__).with_name("count")
run = int(count.read_text()) if count.exists() else 0
count.write_text(str(run + 1))
rows = [{{"name": name, "unit": unit, "p50": times[run % len(times)]}} for name, unit, times in {rows}]
pathlib.Path(sys.argv[sys.argv.index("--json") + 1]).write_text(json.dumps(rows))
"""


@pytest.fixture
def build(tmp_path):
    """Returns a function that creates a build folder with one benchmark of the rows (name, unit, times)."""

    def make(name, *rows):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "contact_bench").write_text(BENCH.format(python=sys.executable, rows=list(rows)))
        (folder / "contact_bench").chmod(0o755)
        return folder

    return make


def compare(*arguments):
    """Returns the exit status, the verdict of each row by name, and the whole output."""
    done = subprocess.run([sys.executable, *map(str, (TOOL, *arguments))], text=True, capture_output=True)
    rows = [line for line in done.stdout.splitlines() if line.startswith("contact: ")]
    return done.returncode, {line.split()[1]: line.split()[-1] for line in rows}, done.stdout + done.stderr


STEADY = [10.0, 10.02, 9.99, 10.01, 10.0]
NOISY = [10.0, 13.0, 9.0, 12.0, 10.0]


def test_equal_times_are_not_slower(build):
    status, verdicts, text = compare(build("a", ("f", "us", STEADY)), build("b", ("f", "us", STEADY)), "contact")
    assert (status, verdicts) == (0, {"f": "%"}), text
    assert "0 of 1 rows are slower by more than 3 %" in text


@pytest.mark.parametrize("factor, status, verdict", [(1.1, 1, "SLOWER"), (1.02, 0, "%"), (0.5, 0, "%")])
def test_a_row_fails_when_it_is_slower_than_the_bound(build, factor, status, verdict):
    rows = [("f", "us", [factor * time for time in STEADY]), ("g", "ms", STEADY)]
    found = compare(build("a", ("f", "us", STEADY), ("g", "ms", STEADY)), build("b", *rows), "contact")
    assert found[:2] == (status, {"f": verdict, "g": "%"}), found[2]


def test_the_bound_is_an_option(build):
    builds = build("a", ("f", "us", STEADY)), build("b", ("f", "us", [1.1 * time for time in STEADY]))
    assert compare(*builds, "contact", "--bound", 20)[0] == 0


def test_differences_within_the_noise_are_marked_and_do_not_fail(build):
    builds = build("a", ("f", "us", NOISY)), build("b", ("f", "us", [1.1 * time for time in NOISY]))
    status, verdicts, text = compare(*builds, "contact")
    assert (status, verdicts) == (0, {"f": "slower?"}), text


def test_rows_without_times_or_in_one_build_only_are_ignored(build, tmp_path):
    one = build("a", ("f", "us", STEADY), ("error", "1", [1.0]), ("gone", "us", STEADY))
    other = build("b", ("f", "us", STEADY), ("error", "1", [9.0]), ("new", "us", [99.0]))
    status, verdicts, _ = compare(one, other, "contact", "--json", tmp_path / "rows.json")
    assert status == 0
    assert verdicts == {"f": "%", "gone": "build", "new": "build"}
    assert [row["name"] for row in json.loads((tmp_path / "rows.json").read_text())] == ["contact: f"]


def test_both_builds_run_in_every_round(build, tmp_path):
    compare(build("a", ("f", "us", STEADY)), build("b", ("f", "us", STEADY)), "contact", "--rounds", 4)
    assert [(tmp_path / name / "count").read_text() for name in "ab"] == ["4", "4"]


def test_a_benchmark_that_fails_is_an_error(build):
    one = build("a", ("f", "us", STEADY))
    (one / "contact_bench").write_text("#!/bin/sh\necho broken >&2\nexit 3\n")
    status, _, text = compare(one, build("b", ("f", "us", STEADY)), "contact")
    assert status == 2
    assert "broken" in text
