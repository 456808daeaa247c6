"""How strongly a stimulus is felt: levels above the threshold of touch, in every output."""

import json
import re

import pytest

from conftest import ROOT

FIELD = ROOT / "data" / "four-plumes.json"
LINE = re.compile(r"^  sensation level: about (\d+) dB (above|below) the threshold of touch \((-?\d+) to (-?\d+) dB\): ",
                  re.MULTILINE)


@pytest.fixture
def planned(prostm, tmp_path):
    """The text and the file of a plan made for an array."""
    done = prostm("plan", FIELD, "--preset", "fast", "--array", "usx", "--json", "plan.json")
    return done.stdout, json.loads((tmp_path / "plan.json").read_text())


def level_in(text):
    found = LINE.search(text)
    assert found, text
    return int(found[1]) * (-1 if found[2] == "below" else 1), int(found[3]), int(found[4])


def test_a_plan_states_its_level_and_interval(planned):
    text, plan = planned
    sensation = plan["sensation"]
    level, low, high = level_in(text)
    assert level == pytest.approx(sensation["level_db"], abs=0.5)
    assert [low, high] == pytest.approx(sensation["interval_db"], abs=0.5)
    assert sensation["amplitude"] == "measured" and "nominal amplitude of" not in text
    assert plan["metrics"]["sensation_level"] == sensation["level_db"]
    assert -20 < sensation["level_db"] < 20


def test_a_plan_without_an_array_has_none(prostm):
    done = prostm("plan", FIELD, "--preset", "fast", "--json", "-")
    assert "sensation" not in json.loads(done.stdout) and not LINE.search(done.stderr)


def test_the_field_of_a_plan_has_the_same_level(prostm, tmp_path, planned):
    text = prostm("field", "plan.json", "--field", FIELD, "--json", "field.json").stdout
    felt = json.loads((tmp_path / "field.json").read_text())["felt"]
    assert felt["sensation"] == pytest.approx(planned[1]["sensation"])
    assert level_in(text)[0] == level_in(planned[0])[0] and "at the nominal amplitude" in text


@pytest.mark.long
def test_levels_follow_the_intensity(prostm, tmp_path, planned):
    def level(*options):
        out = prostm("field", "plan.json", *options, "--json", "-").stdout
        return json.loads(out)["felt"]["sensation"]["level_db"]

    (tmp_path / "weak.toml").write_text(
        f"[emit]\nsilent_below = 0\nfull_scale_pressure = {4 * planned[1]['full_scale_pressure']}\n")
    assert level("--settings", "weak.toml") == pytest.approx(level() - 12.04, abs=0.5)
    assert level("--full-scale-pa", "300") == pytest.approx(level("--full-scale-pa", "600") - 12.04, abs=0.1)


@pytest.mark.long
def test_an_array_without_a_measurement_is_taken_as_nominal(prostm, tmp_path, planned):
    out = json.loads(prostm("solve", ROOT / "data" / "foci.json", "--json", "-").stdout)
    array = {"format": "prostm-array/1", "name": "mine", "frequency_hz": 40000, "radius_mm": 4.5,
             "directivity": "piston", "amplitude_pa_m": 3.4, "transducers_mm": out["transducers_mm"]}
    levels = {}
    for name, measured in (("nominal", {}), ("measured", {"measured_amplitude_pa_m": 1.7})):
        (tmp_path / "array.json").write_text(json.dumps({**array, **measured}))
        text = prostm("field", "plan.json", "--array", "array.json", "--json", f"{name}.json").stdout
        sensation = json.loads((tmp_path / f"{name}.json").read_text())["felt"]["sensation"]
        assert sensation["amplitude"] == name and ("no sound level was measured" in text) == (not measured)
        levels[name] = sensation["level_db"]
    assert levels["measured"] == pytest.approx(levels["nominal"] - 12.04, abs=0.01)


@pytest.mark.long
def test_a_run_reports_the_median_of_its_plans(prostm, tmp_path):
    def run(scene, seconds="6"):
        text = prostm("run", "--hand", "scripted", "--grid", "32", "--preset", "fast", "--seconds", seconds, "--stepped",
                      "--scene", scene, "--json", "run.json").stdout
        return text, json.loads((tmp_path / "run.json").read_text())["sensation"]

    text, plumes = run("four-plumes")
    assert 1 <= plumes["plans"] <= 3 and plumes["amplitude"] == "measured"
    assert plumes["lowest_db"] <= plumes["level_db"] <= plumes["highest_db"]
    assert level_in(text)[0] == pytest.approx(plumes["level_db"], abs=0.5)
    assert run("four-plumes", "3")[1] is None  # too short
    # in still air only the hand's own movement presses
    assert run("still-air")[1]["level_db"] < plumes["level_db"] - 6
