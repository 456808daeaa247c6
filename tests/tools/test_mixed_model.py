"""The scripts that fit models of participants to a tidy table, compared with closed forms for balanced tables, with the
effects of simulated tables, and with a published fit."""

import math
import random
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


@pytest.fixture
def r_model():
    """Returns a function that fits a table by mixed_model.R, and returns what it prints."""
    if shutil.which("Rscript") is None:
        pytest.skip("needs Rscript with the package lme4 (apt: r-cran-lme4)")
    needs(["Rscript", "-e", "library(lme4)"], "the package lme4 of R (apt: r-cran-lme4)")

    def run(table):
        done = subprocess.run(["Rscript", str(TOOLS / "mixed_model.R"), str(table)], text=True, capture_output=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def of_r(printed):
    """Returns (odds ratio, from, to, p) of each term that mixed_model.R prints."""
    rows = re.findall(r"^(\(?[\w-]\S*) +" + r"([\d.e+-]+) +" * 3 + r"([\d.e+-]+)$", printed, re.M)
    return {name: tuple(map(float, numbers)) for name, *numbers in rows}


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


def test_the_mixed_model_of_identical_people_follows_from_their_counts(r_model, tmp_path):
    counts = {"pro-stm": {"x": [15] * 8, "y": [12] * 8}, "am": {"x": [11] * 8, "y": [10] * 8}}
    printed = r_model(write(tmp_path / "tidy.csv", counts))
    assert "640 answers of 16 participants" in printed
    found = of_r(printed)
    assert found["methodam"][0] == pytest.approx((11 / 9) / (15 / 5), rel=0.01)
    assert found["sceney"][0] == pytest.approx((12 / 8) / (15 / 5), rel=0.01)


# log-odds of a right answer of the average person, and the standard deviation of people
TRUTH = {"intercept": 0.4, "method": 0.9, "scene": -0.5, "both": 0.0}
SPREAD = 0.8


def simulate(path, people=60, trials=16):
    """Writes right and wrong answers of people with both methods in both scenes, and a trial without an answer."""
    draw = random.Random(17)
    rows = ["participant,method,scene,trial,correct", "0,am,one,0,"]
    for person in range(people):
        own = draw.gauss(TRUTH["intercept"], SPREAD)
        for method in range(2):
            for scene in range(2):
                log_odds = own + TRUTH["method"] * method + TRUTH["scene"] * scene + TRUTH["both"] * method * scene
                for trial in range(trials):
                    right = draw.random() < 1 / (1 + math.exp(-log_odds))
                    condition = f"{('am', 'pro-stm')[method]},{('one', 'four')[scene]}"
                    rows.append(f"{person},{condition},{(2 * method + scene) * trials + trial + 1},{int(right)}")
    path.write_text("\n".join(rows) + "\n")
    return path


R_TERMS = {"intercept": "(Intercept)", "method": "methodpro-stm", "scene": "scenefour",
           "both": "methodpro-stm:scenefour"}
PYTHON_TERMS = {"intercept": "Intercept", "method": "method[T.pro-stm]", "scene": "scene[T.four]",
                "both": "method[T.pro-stm]:scene[T.four]"}


def test_the_mixed_model_finds_simulated_effects(r_model, tmp_path):
    printed = r_model(simulate(tmp_path / "tidy.csv"))
    assert printed.startswith("3840 answers of 60 participants\n")
    assert float(re.search(r"between participants: ([\d.]+)", printed)[1]) == pytest.approx(SPREAD, abs=0.2)
    found = of_r(printed)
    for name, term in R_TERMS.items():
        ratio, low, high, _ = found[term]
        assert math.log(ratio) == pytest.approx(TRUTH[name], abs=0.25), term
        assert low < math.exp(TRUTH[name]) < high, term


# Averages over people are nearer to 0 by the factor (1 + 0.346 variance)^-1/2 (S. L. Zeger et al., Biometrics 44, 1049
# (1988), with c^2 = (16 sqrt(3) / (15 pi))^2).
def test_population_averages_find_simulated_effects(python, tmp_path):
    done = python(simulate(tmp_path / "tidy.csv"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("3840 answers of 60 participants\n")
    found = {name: float(ratio) for name, ratio, *_ in ROW.findall(done.stdout)}
    nearer = (1 + 0.346 * SPREAD**2) ** -0.5
    for name, term in PYTHON_TERMS.items():
        assert math.log(found[term]) == pytest.approx(nearer * TRUTH[name], abs=0.25), term


def test_both_scripts_agree(python, r_model, tmp_path):
    table = simulate(tmp_path / "tidy.csv")
    of_one = of_r(r_model(table))
    averages = {name: float(ratio) for name, ratio, *_ in ROW.findall(python(table).stdout)}
    nearer = (1 + 0.346 * SPREAD**2) ** -0.5
    for name, term in PYTHON_TERMS.items():
        assert math.log(averages[term]) == pytest.approx(nearer * math.log(of_one[R_TERMS[name]][0]), abs=0.06), term


# Contagious bovine pleuropneumonia in herds (M. Lesnoff et al., Prev. Vet. Med. 64, 27 (2004)), data "cbpp" of lme4.
# The example of its help page, cbind(incidence, size - incidence) ~ period + (1 | herd), prints the log-odds -1.3983,
# -0.9919, -1.1282, -1.5797 with errors 0.2312, 0.3032, 0.3228, 0.4220, and 0.6421 between herds. A row for each animal
# is the same model, with herds as participants and periods as methods.
CBPP = """
data(cbpp, package = "lme4")
rows <- cbpp[rep(seq_len(nrow(cbpp)), cbpp$size), ]
write.csv(data.frame(participant = rows$herd, method = rows$period, scene = "x",
                     correct = as.integer(sequence(cbpp$size) <= rows$incidence)), "tidy.csv", row.names = FALSE)
"""


def test_the_mixed_model_fits_herds_as_published(r_model, tmp_path):
    subprocess.run(["Rscript", "-e", CBPP], cwd=tmp_path, check=True, capture_output=True)
    printed = r_model(tmp_path / "tidy.csv")
    assert printed.startswith("842 answers of 15 participants\n") and "between participants: 0.642 " in printed
    published = {"(Intercept)": (-1.3983, 0.2312), "method2": (-0.9919, 0.3032), "method3": (-1.1282, 0.3228),
                 "method4": (-1.5797, 0.4220)}
    found = of_r(printed)
    assert found.keys() == published.keys()
    for term, (log_odds, error) in published.items():
        expected = [math.exp(log_odds + z * error) for z in (0, -1.959964, 1.959964)]
        assert found[term][:3] == pytest.approx(expected, rel=3e-3), term
