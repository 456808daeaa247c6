"""Shape by Eq. (1), felt shape, felt strength and spill of a plan: plan, field, run, the page and the module give the
same numbers, in text and in JSON, and in the same order."""

import json
import re
import signal
import statistics
import subprocess
from pathlib import Path

import numpy as np
import prostm
import pytest
from page_client import numbers, page_says
from waiting import wait_for

NAMES = {"shape by Eq. (1)": "skill_0", "felt shape": "felt_skill", "felt strength": "sensation_level",
         "spill": "spill"}
PRESETS = ["best", "fast", "felt", "paper-valid"]
WAVE = Path(__file__).resolve().parents[2] / "data/wave.hands.jsonl"


def bumps(seed):
    """Returns one to four bumps on skin of 24 × 20 cells, with a corner that is not skin."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:20, 0:24] * 5.0
    pressure = np.zeros_like(x)
    for _ in range(1 + seed % 4):
        centre, width = random.uniform((25, 20), (95, 80)), random.uniform(6, 18)
        pressure += random.uniform(0.4, 1) * np.exp(-((x - centre[0]) ** 2 + (y - centre[1]) ** 2) / (2 * width**2))
    pressure[:4, :4] = np.nan
    return pressure


def printed(text):
    """Returns the four numbers of a text as printed, by name, in their order."""
    pattern = "|".join(re.escape(name) for name in NAMES)
    return dict(re.findall(rf"^  ({pattern}) +(\S.*)$", text, re.MULTILINE))


def as_printed(metrics):
    """Returns the same for metrics of a file or of the module."""
    return {"shape by Eq. (1)": f"{metrics['skill_0']:.2f}", "felt shape": f"{metrics['felt_skill']:.2f}",
            "felt strength": prostm.sensation_words(metrics["sensation_level"], "usx"),
            "spill": f"{metrics['spill']:.3f}"}


@pytest.mark.parametrize("seed", range(20))
def test_numbers_of_one_name_are_equal(program, tmp_path, seed):
    np.save(tmp_path / "field.npy", bumps(seed))
    field, plan = [tmp_path / "field.npy", "--cell-mm", 5], tmp_path / "a.plan.json"
    preset = PRESETS[seed % len(PRESETS)]
    text = program("plan", *field, "--preset", preset, "--array", "usx", "--json", plan).stdout
    saved = json.loads(plan.read_text())
    expected = as_printed(saved["metrics"])
    assert list(printed(text)) == list(NAMES) and printed(text) == expected

    text = program("field", plan, "--field", *field, "--array", "usx", "--json", tmp_path / "field.json").stdout
    quality = json.loads((tmp_path / "field.json").read_text())["quality"]
    assert list(printed(text)) == list(NAMES) and printed(text) == expected == as_printed(quality)

    result = prostm.plan(tmp_path / "field.npy", preset, cell_mm=5, sigma=saved["sigma_mm"] / 1000)
    assert as_printed(result.metrics(array="usx").as_dict()) == expected


def write_glimpse(path, first, last):
    """Writes a recording of 6 s in which a hand is seen only between two times [s]."""
    head, *lines = WAVE.read_text().splitlines()
    frames = [frame for frame in map(json.loads, lines) if frame["t"] < 6]
    for frame in frames:
        if not first <= frame["t"] < last:
            frame["hands"] = []
    path.write_text("\n".join([head, *map(json.dumps, frames)]) + "\n")


def recorded_plans(path):
    recording = prostm.Recording(path)
    return [plan for plan in map(recording.plan, range(recording.frames)) if plan is not None]


@pytest.mark.parametrize("preset", PRESETS)
def test_a_run_summarises_the_numbers_of_its_plans(program, tmp_path, preset):
    """A run reports five plans at most, so one of five plans reports them all."""
    hands, recording = tmp_path / "glimpse.hands.jsonl", tmp_path / "run.h5"
    write_glimpse(hands, 3.0, 3.24)
    text = program("run", "--hand", hands, "--scene", "four-plumes", "--stepped", "--grid", 32, "--preset", preset,
                   "--seconds", 5, "--record", recording, "--json", tmp_path / "run.json").stdout
    plans = [plan.metrics(array="usx").as_dict() for plan in recorded_plans(recording)]
    assert len(plans) == 5
    quality = json.loads((tmp_path / "run.json").read_text())["quality"]
    assert quality["plans"] == 5 and list(quality)[1:] == list(NAMES.values())
    medians = {}
    for name in NAMES.values():
        values = [plan[name] for plan in plans]
        medians[name] = statistics.median(values)
        assert quality[name] == {"median": pytest.approx(medians[name], rel=1e-9),
                                 "lowest": pytest.approx(min(values), rel=1e-9),
                                 "highest": pytest.approx(max(values), rel=1e-9)}
    lines, expected = printed(text), as_printed(medians)
    assert list(lines) == list(NAMES)
    for name, words in expected.items():
        assert lines[name].startswith(words), name


def test_the_page_gets_the_numbers_of_recorded_plans(program_file, tmp_path):
    write_glimpse(tmp_path / "glimpse.hands.jsonl", 2.0, 6.0)
    process = subprocess.Popen(
        [program_file, "run", "--view", "--view-port", "0", "--hand", "glimpse.hands.jsonl", "--scene", "four-plumes",
         "--grid", "32", "--preset", "fast", "--seconds", "600", "--record", "run.h5", "--json", "run.json"],
        cwd=tmp_path, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        address = process.stdout.readline().split()[1]
        with page_says(address, {"type": "rate", "hz": 1}):  # the percept is computed while a page is connected
            wait_for(lambda: None not in map(numbers(address)["numbers"].get, NAMES.values()), seconds=300)
        with page_says(address, {"type": "transport", "do": "pause"}):
            wait_for(lambda: numbers(address)["run"]["flags"] & 1)
            shown = numbers(address)["numbers"]
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    if json.loads((tmp_path / "run.json").read_text())["unrecorded"] > 0:
        pytest.skip("the machine is too busy to record each update")
    plans = recorded_plans(tmp_path / "run.h5")

    def equal(metrics, name):
        return metrics.as_dict()[name] == pytest.approx(shown[name], rel=1e-6)  # numbers of a page have 32 bits

    of_model = [plan.metrics() for plan in plans]
    assert any(equal(metrics, "skill_0") and equal(metrics, "spill") for metrics in of_model)
    felt = (plan.metrics(array="usx") for plan in plans)  # of one of the last seconds' plans
    assert any(equal(metrics, "felt_skill") and equal(metrics, "sensation_level") for metrics in felt)


def test_a_number_with_another_definition_has_another_name(program, tmp_path):
    """The shape and the spill of the radiation pressure and of the percept are in a table of their own."""
    np.save(tmp_path / "field.npy", bumps(3))
    field, plan = [tmp_path / "field.npy", "--cell-mm", 5], tmp_path / "a.plan.json"
    program("plan", *field, "--array", "usx", "--json", plan)
    document = json.loads(program("field", plan, "--field", *field, "--json", "-").stdout)
    assert document["quality"]["spill"] != document["felt"]["metrics"]["spill"]
    assert set(NAMES.values()) <= set(document["quality"])
