"""prostm study power, preregister, and analyse with a plan, bounds of equivalence, or paired comparisons."""

import json
import random
import re
import subprocess
import sys
import time

import pytest

from conftest import ROOT, SHORT

MADE_UP = ROOT / "data" / "made-up-answers.csv"
WITHIN = '[study]\nparticipants = 2\nmethods = "within"\n' + SHORT + "[method.pro-stm.fluid]\ncells = 32\n"


def test_expected_sizes_are_those_of_scipy():
    script = ROOT / "tests/study/analysis/make_expected_effects.py"
    if subprocess.run([sys.executable, "-c", "import scipy"], capture_output=True).returncode != 0:
        pytest.skip("needs scipy (apt: python3-scipy)")
    done = subprocess.run([sys.executable, str(script), "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_an_analysis_has_sizes_and_no_post_hoc_power(prostm, refuses, tmp_path):
    said = prostm("study", "analyse", MADE_UP, "--equivalence", "0.1", "--json", "a.json").stdout
    assert "needed" not in said and "Exploratory: without a plan" in said and "equal p" in said
    analysis = json.loads((tmp_path / "a.json").read_text())
    assert analysis["exploratory"] is True and analysis["confirmatory"] is None and "power" not in analysis
    comparisons = [c for scene in analysis["scenes"] for c in scene["comparisons"]]
    order = sorted(comparisons, key=lambda c: c["permutation_p"])
    most = 0.0
    for place, of in enumerate(order):  # Holm's correction over all comparisons
        most = max(most, min(1.0, (len(order) - place) * of["permutation_p"]))
        assert of["holm_p"] == pytest.approx(most)
    for of in comparisons:
        assert "participants_needed" not in of
        for name in ("difference", "effect_size"):
            low, high = of[f"{name}_interval"]
            assert low < of[name] < high
        assert of["bayes_factor"] > 0 and of["equivalence"]["bound"] == 0.1
        low, high = of["equivalence"]["interval"]
        assert (-0.1 < low and high < 0.1) == (of["equivalence"]["p"] < 0.05)
    refuses("study", "analyse", MADE_UP, "--equivalence", "0", words=["equivalence = 0", "0.001"])
    refuses("study", "analyse", MADE_UP, "--power", "0.8", words=["--power"])
    refuses("study", "analyse", MADE_UP, "--ties", "half", words=["--ties", "a, b, preferred"])


def test_power_is_simulated(prostm, refuses, tmp_path):
    design = ["study", "power", "--d", "0.5", "--methods", "within"]
    said = prostm(*design, "--participants", "34", "--json", "a.json").stdout
    found = json.loads((tmp_path / "a.json").read_text())
    # the noncentral t distribution gives 0.808 for 34, and 34 and 44 participants
    assert found["power"]["power"] == pytest.approx(0.808, abs=0.035)
    low, high = found["power"]["interval"]
    assert low < found["power"]["power"] < high
    needed = [of["participants"] for of in found["needed"]]
    assert needed[0] == pytest.approx(34, abs=3) and needed[1] == pytest.approx(44, abs=4)
    assert f"80 % power needs {needed[0]} participants\n" in said
    assert prostm(*design, "--participants", "34").stdout == said.replace("wrote a.json\n", "")
    shares = ["study", "power", "--first", "0.6", "--second", "0.75"]
    assert "participants with each method" in prostm(*shares).stdout
    refuses("study", "power", words=["--first 0.6 --second 0.75", "--d 0.5"])
    refuses("study", "power", "--first", "0.5", words=["--second"])
    refuses(*shares, "--alike", "0.5", words=["--alike", "--methods within"])
    refuses("study", "power", "--d", "0.5", "--trials", "8", words=["--trials", "--d"])
    refuses(*shares, "--methods", "both", words=["--methods", "between", "within"])
    refuses("study", "power", "--first", "1.5", "--second", "0.7", words=["the first share = 1.5", "0.99"])
    assert "needs more than 2000" in prostm("study", "power", "--d", "0.02", "--studies", "100").stdout


def write_pairs(path, rows, header="participant,a,b,preferred"):
    path.write_text("\n".join([header, *rows]) + "\n")


def test_paired_comparisons_are_ranked(prostm, refuses, tmp_path):
    rows = ["1,x,y,x"] * 9 + ["1,y,x,y"] * 3 + ["2,x,z,x"] * 8 + ["2,z,x,z"] * 2 + ["2,y,z,y"] * 6 + ["1,z,y,z"] * 5
    write_pairs(tmp_path / "a.csv", rows)
    said = prostm("study", "analyse", "a.csv", "--json", "a.json").stdout
    assert said.startswith("33 comparisons of 3 stimuli by 2 participants\n")
    assert "From most to least preferred: x, y, z." in " ".join(said.split())
    found = json.loads((tmp_path / "a.json").read_text())
    assert found["kind"] == "pairs" and found["exploratory"] is True
    assert sum(of["ability"] for of in found["stimuli"]) == pytest.approx(0, abs=1e-9)
    assert {of["stimulus"]: of["preferred"] for of in found["stimuli"]} == {"x": 17, "y": 9, "z": 7}
    write_pairs(tmp_path / "t.csv", rows + ["2,x,y,tie", "2,x,y,"])
    refuses("study", "analyse", "t.csv", words=["t.csv, line 35", "tie", "--ties half"])
    assert "34 comparisons" in prostm("study", "analyse", "t.csv", "--ties", "half").stdout
    omitted = prostm("study", "analyse", "t.csv", "--ties", "omit").stdout
    assert "33 comparisons" in omitted and "1 ties are left out" in omitted and "1 rows without" in omitted
    write_pairs(tmp_path / "b.csv", rows + ["1,x,y,z"])
    refuses("study", "analyse", "b.csv", words=["b.csv, line 35", 'preferred is "z"'])
    write_pairs(tmp_path / "c.csv", ["1,x,y,x", "1,y,z,y"])
    refuses("study", "analyse", "c.csv", words=["none of", "no finite abilities"])
    refuses("study", "analyse", "a.csv", "--figure", "a.svg", words=["--figure", "paired comparisons"])
    refuses("study", "analyse", "a.csv", MADE_UP, words=["a.csv", "separately"])


def test_a_plan_is_written_before_answers_and_run_after(prostm, refuses, tmp_path):
    (tmp_path / "short.toml").write_text(WITHIN)
    planned = prostm("study", "preregister", "short.toml", "-o", "plan.jsonl", "--each-scene", "--equivalence", "0.2",
                     "--note", "PRO-STM is better.").stdout
    text = (tmp_path / "plan.jsonl").read_text()
    digest = re.search(r"SHA-256 of the plan: ([0-9a-f]{64})\n", planned)[1]
    hashed = subprocess.run(["sha256sum", tmp_path / "plan.jsonl"], capture_output=True, text=True).stdout.split()[0]
    assert digest == hashed
    refuses("study", "preregister", "short.toml", "-o", "plan.jsonl", words=["plan.jsonl exists"])
    time.sleep(1.1)
    for participant in "12":
        prostm("study", "run", "short.toml", "--view-port", "0", "--participant", participant, "--rehearse", "0")
    files = [f"answers/rehearsal-{n}.jsonl" for n in "12"]
    said = prostm("study", "analyse", *files, "--plan", "plan.jsonl", "--json", "a.json").stdout
    assert said.index("Confirmatory: plan.jsonl") < said.index("1. right: am and pro-stm in all scenes") < said.index(
        "2. right: am and pro-stm in one-plume") < said.index("Exploratory:") < said.index("permutation")
    found = json.loads((tmp_path / "a.json").read_text())["confirmatory"]
    assert found["sha256"] == digest and found["participants"] == 2 and len(found["results"]) == 3
    assert [of["scene"] for of in found["results"]] == [None, "one-plume", "four-plumes"]
    (tmp_path / "changed.jsonl").write_text(text.replace('"alpha":0.05', '"alpha":0.10'))
    refuses("study", "analyse", *files, "--plan", "changed.jsonl", words=["changed.jsonl, line 3 does not match"])
    (tmp_path / "other.toml").write_text(WITHIN.replace("repeats = 1", "repeats = 2"))
    prostm("study", "preregister", "other.toml", "-o", "other.jsonl")
    refuses("study", "analyse", *files, "--plan", "other.jsonl",
            words=["answers/rehearsal-1.jsonl, line 1", "trials.repeats is 1, and 2 in the plan"])
    prostm("study", "preregister", "short.toml", "-o", "late.jsonl")
    refuses("study", "analyse", *files, "--plan", "late.jsonl", words=["rehearsal-1.jsonl was begun", "before late.jsonl"])
    refuses("study", "analyse", MADE_UP, "--plan", "plan.jsonl", words=["made-up-answers.csv", ".jsonl"])
    # a participant's file, even without an answer, is an answer
    first = (tmp_path / files[0]).read_text().splitlines()[0]
    assert '"rehearsal":true' in first
    import zlib
    body = first[:first.rindex(',"check":')].replace('"rehearsal":true', '"rehearsal":false')
    (tmp_path / "answers" / "participant-9.jsonl").write_text(
        f'{body},"check":"{zlib.crc32(body.encode()):08x}"}}\n')
    refuses("study", "preregister", "short.toml", "-o", "new.jsonl", words=["participant-9.jsonl has answers already"])
    assert not (tmp_path / "new.jsonl").exists()


@pytest.mark.long
def test_many_answers_are_analysed(prostm, tmp_path):
    draw = random.Random(3)
    rows = [f"{person},{method},{scene},{int(draw.random() < 0.7)}" for person in range(200)
            for method in ("am", "pro-stm") for scene in ("x", "y") for _ in range(125)]
    (tmp_path / "a.csv").write_text("participant,method,scene,correct\n" + "\n".join(rows) + "\n")
    prostm("study", "analyse", "a.csv", "--equivalence", "0.1", "--json", "a.json")
    document = json.loads((tmp_path / "a.json").read_text())
    assert [m["answers"] for m in document["scenes"][0]["methods"]] == [50_000, 50_000]
