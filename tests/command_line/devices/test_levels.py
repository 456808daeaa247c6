"""prostm levels: caps, levels and limits. Caps can only be lowered."""

import json

import pytest


def levels(prostm, tmp_path, *arguments):
    prostm("levels", "--json", "levels.json", *arguments)
    return json.loads((tmp_path / "levels.json").read_text())


@pytest.mark.parametrize("array", ["usx", "autd3"])
def test_levels_are_intervals_next_to_caps_and_limits(prostm, tmp_path, array):
    result = levels(prostm, tmp_path, "--array", array)
    assert result["format"] == "prostm-levels/1" and result["array"] == array
    for row in result["focus"]:
        assert 0 < row["acoustic_low_pa"] <= row["acoustic_pa"] < row["acoustic_high_pa"]
        assert 0 < row["radiation_low_pa"] <= row["radiation_pa"] < row["radiation_high_pa"]
    assert [row["distance_m"] for row in result["head"]] == [0.3, 0.5, 1.0]
    for row in result["head"]:
        assert row["low_db"] < row["likely_db"] < row["estimate_db"] < row["bound_db"]
    assert result["caps"]["head_level"] == 145
    assert [limit["level_db"] for limit in result["limits"]] == [100, 110, 110, 115]
    study, demo = result["recommended"]
    assert [study["use"], demo["use"]] == ["study", "demo"]
    assert 0 <= study["felt_strength_lost_db"] < demo["felt_strength_lost_db"]
    assert all(limit["source"] and limit["scope"] for limit in result["limits"])


def test_the_table_names_its_columns(prostm):
    out = prostm("levels").stdout
    for words in ("Caps ([safety]; lower ones can be set)", "study  [safety] head_level = ", "demo   [safety] head_level = ", "mean_radiation_pressure", "200 mm", "0.5 m", "ACGIH",
                  "docs/devices/safety.md"):
        assert words in out


def test_a_cap_can_be_lowered_and_never_raised(prostm, refuses, tmp_path):
    (tmp_path / "low.toml").write_text("[safety]\nhead_level = 120\nmean_radiation_pressure = 50\n")
    assert levels(prostm, tmp_path, "--settings", "low.toml")["caps"]["head_level"] == 120
    for key, value in {"head_level": 146, "power": 4.1, "intensity": 1.1, "acoustic_pressure": 15e3,
                       "radiation_pressure": 3100, "mean_radiation_pressure": 2600, "head_distance": 0.6}.items():
        (tmp_path / "high.toml").write_text(f"[safety]\n{key} = {value}\n")
        refuses("levels", "--settings", "high.toml", words=(key, "must be between"))


@pytest.mark.long
def test_lowered_caps_weaken_a_run_and_are_reported(prostm, tmp_path):
    (tmp_path / "low.toml").write_text("[safety]\nmean_radiation_pressure = 50\n")
    run = ("run", "--stepped", "--grid", "32", "--seconds", "4", "--json", "run.json")
    prostm(*run)
    free = json.loads((tmp_path / "run.json").read_text())["safety"]
    out = prostm(*run, "--settings", "low.toml").stdout
    capped = json.loads((tmp_path / "run.json").read_text())
    assert free["mean_radiation_pressure"] == 0 and free["mean_high_pa"] > 50
    assert capped["safety"]["mean_radiation_pressure"] > 0 and capped["safety"]["mean_high_pa"] <= 50 / 1.09
    assert capped["limited_samples"] == 0, "no stage is at fault"
    assert "to keep the caps of [safety], most of them for mean_radiation_pressure" in out
