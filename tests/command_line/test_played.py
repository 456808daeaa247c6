"""Speeds and periods as played, in every output; settings and levels above the limits are rejected with their place."""

import json
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
RATE = 40e3  # emission rate [Hz]


@pytest.fixture
def field(tmp_path):
    """Two bumps of pressure on a round hill."""
    y, x = np.mgrid[0:24, 0:30] * 5.0
    p = np.exp(-((x - 60) ** 2 + (y - 60) ** 2) / 900) + 0.7 * np.exp(-((x - 100) ** 2 + (y - 40) ** 2) / 300)
    height = 12.0 * np.exp(-((x - 70) ** 2 + (y - 55) ** 2) / 1500)
    path = tmp_path / "field.json"
    path.write_text(json.dumps({
        "format": "prostm-field/1", "cell_mm": 5.0, "origin_mm": [0, 0], "rows": 24, "cols": 30,
        "pressure": p.tolist(), "height_mm": height.tolist(),
        "plane": {"origin_mm": [-75, -60, 200], "x": [1, 0, 0], "y": [0, 1, 0]}}))
    return path


def settings(tmp_path, text):
    path = tmp_path / "s.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("preset", ["paper", "best", *(pytest.param(preset, marks=pytest.mark.long)
                                                        for preset in ["paper-valid", "fast", "felt"])])
def test_plan_and_field_report_what_is_played(prostm, field, tmp_path, preset):
    toml = settings(tmp_path, f'[plan]\npreset = "{preset}"\nspeed = 8\npaths = 2\n')
    plan = json.loads(prostm("plan", field, "--settings", toml, "--json", "-").stdout)
    (tmp_path / "p.json").write_text(json.dumps(plan))
    played = json.loads(prostm("field", "p.json", "--json", "-").stdout)
    assert played["warnings"] == []
    assert len(plan["played"]) == len(plan["paths"])
    for path, own, emitted in zip(plan["paths"], plan["played"], played["paths"], strict=True):
        samples = own["period_ms"] * 1e-3 * RATE
        assert samples == pytest.approx(round(samples), abs=1e-6), "a whole number of samples"
        assert path["period_ms"] == pytest.approx(own["period_ms"], abs=1.001e3 / RATE)
        assert emitted["period_ms"] == pytest.approx(own["period_ms"], abs=1e-6)
        assert emitted["speed_m_s"] == pytest.approx(own["speed_m_s"], rel=1e-6) and emitted["speed_m_s"] <= 8


def test_a_plan_above_the_limit_is_played_at_the_limit_with_a_warning(prostm, field, tmp_path):
    plan = json.loads(prostm("plan", field, "--preset", "fast", "--paths", "1", "--json", "-").stdout)
    plan["paths"][0]["period_ms"] *= plan["paths"][0]["speed_m_s"] / 10
    plan["paths"][0]["speed_m_s"] = 10
    (tmp_path / "p.json").write_text(json.dumps(plan))
    told = prostm("field", "p.json", "--json", "out.json").stdout
    played = json.loads((tmp_path / "out.json").read_text())
    assert len(played["warnings"]) == 1 and "warning: " + played["warnings"][0] in told
    assert "planned at 10 m/s" in told and "8 m/s at most" in told
    path = played["paths"][0]
    assert path["planned_speed_m_s"] == 10 and 7.9 < path["speed_m_s"] <= 8
    assert path["period_ms"] > 1.2 * path["planned_period_ms"]
    assert played["loop"]["stretch"][0] > 0.2, "against the plan, not against the limit"


def test_speeds_above_the_limit_are_rejected_with_their_place(refuses, field, tmp_path):
    toml = settings(tmp_path, "[plan]\n\nspeed = 8.5\n")
    words = ["s.toml, line 3", "speed = 8.5 m/s", "8 m/s"]
    refuses("plan", field, "--settings", toml, words=words)
    refuses("run", "--settings", toml, "--as-fast-as-possible", "--seconds", "1", words=words)


def test_fade_times_below_forty_samples_are_rejected(refuses, field, tmp_path):
    toml = settings(tmp_path, "[emit]\nfade_time = 0.0001\n")
    refuses("plan", field, "--settings", toml, words=["emit.fade_time", "0.001 s", "40 samples"])


@pytest.mark.long
def test_field_and_plan_report_the_same_felt_field(prostm, field, tmp_path):
    prostm("plan", field, "--preset", "fast", "--array", "usx", "--json", "p.json")
    prostm("field", "p.json", "--field", field, "--array", "usx", "--json", "f.json")
    plan = json.loads((tmp_path / "p.json").read_text())
    felt = json.loads((tmp_path / "f.json").read_text())["felt"]["metrics"]
    assert felt["skill_8"] == pytest.approx(plan["metrics"]["felt_skill"], abs=1e-6)


PROTOCOLS = sorted((ROOT / "data" / "protocols").glob("*.toml"))


@pytest.mark.parametrize("protocol", PROTOCOLS, ids=lambda path: path.stem)
def test_study_check_prints_the_presented_values(prostm, protocol):
    told = prostm("study", "check", protocol).stdout
    assert told.rstrip().endswith("every level is played as it is written.")
    presented = json.loads(prostm("study", "check", protocol, "--json", "-").stdout)
    assert presented["format"] == "prostm-study-check/1" and presented["methods"]


LEVELS = """[trials]
task = "judgement"
[level]
setting = "{setting}"
low = {low}
high = {high}
step = 0.5
[scene.one-plume]
question = "?"
[method.a.emit]
full_scale_pressure = 0.31
"""


@pytest.mark.parametrize("setting, low, high, words", [
    ("plan.speed", 2, 14, ["line 6", "level.high = 14", "8 m/s"]),
    ("plan.draw_rate", 20, 1000, ["line 6", "level.high = 1000", "0.01"]),
    ("plan.gain", 1, 5, ["line 6", "level.high = 5", "clipped"]),
    ("plan.gain", 0.02, 2, ["line 5", "level.low = 0.02", "silent"]),
    ("plan.paths", 1.5, 3, ["line 5", "level.low = 1.5", "a whole number"]),
])
def test_levels_that_would_be_clamped_are_rejected(refuses, tmp_path, setting, low, high, words):
    (tmp_path / "p.toml").write_text(LEVELS.format(setting=setting, low=low, high=high))
    refuses("study", "check", "p.toml", words=["p.toml", *words])
    refuses("study", "run", "p.toml", "--participant", "1", words=words)
