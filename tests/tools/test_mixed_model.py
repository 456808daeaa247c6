"""The scripts that fit models of participants to a tidy table, compared with closed forms for balanced tables."""

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[2] / "tools"
ROW = re.compile(r"^(\S+) +(\d+\.\d+)  +(\d+\.\d+) to (\d+\.\d+) +(<?[\d.]+)$", re.M)


def needs(command, what):
    """Skips the test unless the command succeeds."""
    if subprocess.run(command, capture_output=True).returncode != 0:
        pytest.skip(f"needs {what}")


@pytest.fixture
def python():
    needs([sys.executable, "-c", "import pandas, statsmodels"], "pandas and statsmodels (apt: python3-statsmodels)")

    def run(*arguments):
        return subprocess.run([sys.executable, str(TOOLS / "mixed_model.py"), *map(str, arguments)], text=True,
                              capture_output=True)

    return run


def write(path, counts, trials=20):
    """Writes a tidy table; counts are {method: {scene: right answers of each participant}}."""
    rows = ["participant,method,scene,correct"]
    for method, scenes in counts.items():
        for scene, rights in scenes.items():
            for person, right in enumerate(rights):
                rows += [f'"{method}, {person}",{method},{scene},{int(k < right)}' for k in range(trials)]
    path.write_bytes("".join(row + "\r\n" for row in rows).encode())
    return path


def odds(rights, trials=20):
    return sum(rights) / (trials * len(rights) - sum(rights))


COUNTS = {"pro-stm": {"one": [14, 15, 17, 12, 18, 9], "four": [11, 16, 15, 10, 17, 12]},
          "am": {"one": [8, 11, 13, 14, 10, 9], "four": [12, 9, 10, 16, 11, 8]}}


def test_odds_ratios_of_a_balanced_table_follow_from_its_counts(python, tmp_path):
    done = python(write(tmp_path / "tidy.csv", COUNTS))
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("480 answers of 12 participants\n")
    rows = {name: tuple(map(float, numbers)) for name, *numbers, _ in ROW.findall(done.stdout)}
    one, four = (odds(COUNTS["pro-stm"][scene]) for scene in ("one", "four"))
    am_one, am_four = (odds(COUNTS["am"][scene]) for scene in ("one", "four"))
    # relative to the method and scene that come first
    expected = {"Intercept": one, "method[T.am]": am_one / one, "scene[T.four]": four / one,
                "method[T.am]:scene[T.four]": (am_four / four) / (am_one / one)}
    assert rows.keys() == expected.keys()
    for name, (ratio, low, high) in rows.items():
        assert ratio == pytest.approx(expected[name], abs=6e-4)
        assert low < ratio < high


def test_intervals_reflect_people_not_answers(python, tmp_path):
    # people who are nearly always right, or nearly always wrong
    alike = {"am": {"x": [1, 19, 2, 18, 1, 18]}, "pro-stm": {"x": [19, 19, 2, 19, 1, 19]}}
    done = python(write(tmp_path / "tidy.csv", alike))
    assert done.returncode == 0, done.stderr
    _, ratio, low, high, p = ROW.findall(done.stdout)[1]
    assert float(low) < 1.0 < float(high) and float(p) > 0.1
    of_answers = sum(1 / n for rights in alike.values() for n in (sum(rights["x"]), 120 - sum(rights["x"])))
    assert math.log(float(high) / float(low)) > 2.5 * 2 * 1.96 * math.sqrt(of_answers)


def test_one_method_in_one_scene_has_only_an_intercept(python, tmp_path):
    done = python(write(tmp_path / "tidy.csv", {"am": {"x": [8, 11, 13]}}))
    assert [row[0] for row in ROW.findall(done.stdout)] == ["Intercept"], done.stderr


def test_a_table_without_required_columns_is_rejected(python, tmp_path):
    (tmp_path / "a.csv").write_text("participant,method,correct\r\n1,am,1\r\n")
    for name, words in (("a.csv", "has no column scene"), ("none.csv", "none.csv")):
        done = python(tmp_path / name)
        assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


def test_the_mixed_model_of_identical_people_follows_from_their_counts(tmp_path):
    if shutil.which("Rscript") is None:
        pytest.skip("needs Rscript with the package lme4 (apt: r-cran-lme4)")
    needs(["Rscript", "-e", "library(lme4)"], "the package lme4 of R (apt: r-cran-lme4)")
    counts = {"pro-stm": {"x": [15] * 8, "y": [12] * 8}, "am": {"x": [11] * 8, "y": [10] * 8}}
    done = subprocess.run(["Rscript", str(TOOLS / "mixed_model.R"), str(write(tmp_path / "tidy.csv", counts))],
                          text=True, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert "640 answers of 16 participants" in done.stdout
    found = dict(re.findall(r"^(\(?\w\S*) +(\d+\.\d+) ", done.stdout, re.M))
    assert float(found["methodam"]) == pytest.approx((11 / 9) / (15 / 5), rel=0.01)
    assert float(found["sceney"]) == pytest.approx((12 / 8) / (15 / 5), rel=0.01)
