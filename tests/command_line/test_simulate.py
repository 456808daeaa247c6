"""prostm study simulate: model observers instead of people."""

import json
import re
import signal
import subprocess

import pytest

from conftest import shared_file

SMALL = ["study", "simulate", "--hands", "1", "--grid", "32", "--studies", "200"]
NO_PEOPLE = "models, never of people"


@pytest.fixture
def simulated(prostm, tmp_path):
    """Returns a function that simulates a small study and returns its output and its JSON."""

    def run(*arguments):
        said = prostm(*SMALL, *arguments, "--json", "simulated.json").stdout
        return said, json.loads((tmp_path / "simulated.json").read_text())

    return run


@pytest.mark.long
def test_a_study_is_simulated_and_its_answers_are_analysed(simulated, prostm):
    said, result = simulated("--answers", "model.csv")
    assert NO_PEOPLE in said.splitlines()[0] and "likelihoods are missing" in said
    assert said.endswith("wrote model.csv\nwrote simulated.json\n")
    assert result["format"] == "prostm-simulated-study/1"
    rows = {(row["observer"], row["method"]): row for row in result["rows"]}
    assert list(rows) == [(observer, method) for observer in ("skin", "field", "strength", "guess")
                          for method in ("am", "pro-stm")]
    for row in rows.values():
        assert "log_likelihood" not in row
        for scene in ("one-plume", "four-plumes", "both"):
            low, high = row[scene]["interval"]
            assert 0 <= low <= row[scene]["right"] <= high <= 1
    assert rows["guess", "am"]["both"]["right"] == 0.5 and rows["guess", "am"]["d_prime"] == 0
    # the sentence about strength agrees with its rows
    shares = [rows["strength", method]["both"]["right"] for method in ("am", "pro-stm")]
    said_shares = re.findall(r"([\d.]+) % right with (am|pro-stm) \(four plumes feel \d\.\d\d times", result["words"])
    assert said_shares == [(f"{100 * share:.1f}", method) for share, method in zip(shares, ("am", "pro-stm"))]
    assert ("strength is a cue" in result["words"]) == (max(shares) > 0.525)
    assert result["words"] in said
    analysed = prostm("study", "analyse", "model.csv").stdout
    assert analysed.startswith("16 participants, each with one method\n") and "/128" in analysed


@pytest.mark.long
def test_twice_the_noise_halves_sensitivity(simulated):
    _, quiet = simulated("--noise", "1", "--seed", "3")
    _, noisy = simulated("--noise", "2", "--seed", "3")
    for one, two in zip(quiet["rows"], noisy["rows"]):
        assert two["d_prime"] == pytest.approx(one["d_prime"] / 2, rel=1e-9)


@pytest.mark.long
def test_the_papers_scores_have_likelihoods(simulated):
    said, result = simulated("--paper-data", shared_file("data/paper/fig4.json").parent)
    assert "people" in said and "60.9" in said and "75.8" in said and "log L" in said
    assert all(row["log_likelihood"] < 0 for row in result["rows"])
    assert result["people"]["am"]["paper"] == 0.61 and result["people"]["pro-stm"]["both"]["right"] == 97 / 128
    guess = [row["log_likelihood"] for row in result["rows"] if row["observer"] == "guess"]
    assert guess == pytest.approx([-31.9, -51.8], abs=0.05)  # 16 binomial probabilities with p = 1/2 each


@pytest.mark.long
def test_a_signal_ends_it_without_files(program, tmp_path):
    running = subprocess.Popen([str(program), "study", "simulate", "--grid", "32", "--json", "s.json"], cwd=tmp_path,
                               text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert NO_PEOPLE in running.stdout.readline()
    running.send_signal(signal.SIGINT)
    out, errors = running.communicate(timeout=60)
    assert running.returncode == 130 and errors == "" and "nothing was simulated" in out
    assert not (tmp_path / "s.json").exists()
