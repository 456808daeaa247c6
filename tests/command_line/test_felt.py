"""Plans that optimise the felt field: how prostm describes them, and which options it rejects."""

import json
import re

import h5py
import numpy as np
import pytest

from conftest import ROOT

FIELD = ROOT / "data" / "four-plumes.json"


@pytest.fixture
def settings(tmp_path):
    """Returns a function that writes a settings file."""

    def write(text):
        (tmp_path / "s.toml").write_text(text)
        return "s.toml"

    return write


def plan_of(prostm, *options):
    return json.loads(prostm("plan", FIELD, *options, "--json", "-").stdout)


def line_with(text, words):
    lines = [line for line in text.splitlines() if words in line]
    assert len(lines) == 1, text
    return lines[0]


def test_the_weight_is_off_by_default_and_exists_for_both_methods(prostm):
    rows = json.loads(prostm("settings", "felt_weight", "--json", "-").stdout)["settings"]
    assert [(row["group"], row["value"], row["least"], row["most"]) for row in rows] == [
        ("plan", 0, 0, 1), ("am", 0, 0, 1)]
    assert all("0: off" in row["help"] for row in rows)
    for method in ("pro-stm", "am"):
        text = prostm("plan", FIELD, "--method", method).stdout
        assert "in step" not in text and "nobody has felt" not in text and "late" not in text
    assert "loop_ms" not in plan_of(prostm)


@pytest.mark.parametrize("points, chosen", [("false", "pressures"), ("true", "points and pressures")])
def test_one_line_reports_the_optimisation_and_that_it_is_untested_on_people(prostm, settings, points, chosen):
    file = settings(f"[plan]\nfelt_weight = 0.9\nfelt_points = {points}\n")
    line = line_with(prostm("plan", FIELD, "--settings", file).stdout, "nobody has felt it")
    plan = plan_of(prostm, "--settings", file)
    assert line == (f"  in step: all paths come round together every {plan['loop_ms']:.1f} ms; {chosen} chosen by "
                    "what the model of the skin feels (plan.felt_weight 0.9); nobody has felt it")
    assert 10 <= plan["loop_ms"] <= 20
    for path in plan["paths"]:
        laps = plan["loop_ms"] / path["period_ms"]
        assert laps == pytest.approx(round(laps), abs=1e-9) and path["speed_m_s"] <= 7 * (1 + 1e-9)
    assert plan["settings"]["plan"]["felt_weight"] == 0.9
    assert plan["paths"] == plan_of(prostm, "--settings", file)["paths"]


def test_am_reports_it_too(prostm, settings):
    file = settings("[am]\nfelt_weight = 0.5\n")
    text = prostm("plan", FIELD, "--method", "am", "--settings", file).stdout
    assert line_with(text, "nobody has felt it") == (
        "  pressures and phases chosen by what the model of the skin feels (am.felt_weight 0.5); nobody has felt it")
    assert re.search(r"focus \d: .*% of a period late", text)
    assert "felt it" not in prostm("plan", FIELD, "--settings", file).stdout


def test_with_an_array_the_verdict_is_about_the_felt_field(prostm, settings):
    file = settings("[plan]\nfelt_weight = 0.9\n")
    end = " (1 is perfect, 0 is no better than an even field)"
    metrics = plan_of(prostm, "--array", "usx", "--settings", file)["metrics"]
    lines = prostm("plan", FIELD, "--array", "usx", "--settings", file).stdout.splitlines()
    assert lines[1] == (f"4 paths render this field with skill {metrics['skill_0']:.2f} as pressure and "
                        f"skill_8 {metrics['felt_skill']:.2f} as felt by the model{end}")
    metrics = plan_of(prostm, "--settings", file)["metrics"]
    lines = prostm("plan", FIELD, "--settings", file).stdout.splitlines()
    assert lines[1] == (f"4 paths render this field with skill {metrics['skill_0']:.2f} as pressure; "
                        f"--array judges what is felt{end}")


def test_a_pressure_field_that_loses_to_a_control_does_not_imply_that_the_felt_field_does(prostm, settings):
    palm = [ROOT / "data" / "palm.npy", "--cell-mm", "5", "--method", "am"]
    warning = line_with(prostm("plan", *palm).stdout, "loses to the control")
    assert warning.endswith(": the percept will hardly resemble the field")
    warning = line_with(prostm("plan", *palm, "--settings", settings("[am]\nfelt_weight = 1\n")).stdout, "loses to")
    assert warning.endswith(": its pressure hardly resembles the field")


def test_the_arrays_own_field_is_felt_more_like_the_target(prostm, settings):
    lack = {}
    for weight in (0, 0.9):
        plan = plan_of(prostm, "--array", "usx", "--settings", settings(f"[plan]\nfelt_weight = {weight}\n"))
        lack[weight] = 1 - plan["metrics"]["felt_skill"]
    assert lack[0.9] < 0.75 * lack[0]


@pytest.mark.parametrize("text, options, words", [
    ("[plan]\nfelt_weight = 1.5\n", [], "s.toml, line 2: plan.felt_weight = 1.5 must be between 0 and 1"),
    ("[plan]\nfelt_weight = -0.1\n", [], "plan.felt_weight = -0.1 must be between 0 and 1"),
    ("[plan]\nfelt_weight = nan\n", [], "s.toml, line 2: plan.felt_weight must be finite"),
    ("[am]\nfelt_weight = 2\n", ["--method", "am"], "am.felt_weight = 2 must be between 0 and 1"),
    ("[plan]\nfelt_points = 1\n", [], "plan.felt_points"),
    ('[plan]\nfelt_weight = "much"\n', [], "plan.felt_weight"),
    ("[plan]\nfelt_wieght = 0.9\n", [], "felt_weight"),
    ('[plan]\nfelt_weight = 0.9\npreset = "paper"\n', [], "felt_weight is for presets best and fast, not paper"),
    ("[plan]\nfelt_weight = 0.9\n", ["--preset", "paper-valid"],
     "felt_weight is for presets best and fast, not paper-valid"),
])
def test_invalid_options_are_rejected(refuses, settings, text, options, words):
    refuses("plan", FIELD, "--settings", settings(text), *options, words=[words])


@pytest.mark.parametrize("group, method", [("plan", "pro-stm"), ("am", "am")])
def test_a_run_plays_such_plans(prostm, settings, tmp_path, group, method):
    file = settings(f"[{group}]\nfelt_weight = 0.9\n")
    done = prostm("run", "--settings", file, "--method", method, "--grid", "32", "--seconds", "1.5", "--stepped",
                  "--record", "run.h5")
    assert f"({group}.felt_weight 0.9); nobody has felt it" in line_with(done.stdout, "  felt ")
    with h5py.File(tmp_path / "run.h5") as recording:
        loops, phases = recording["plan/loop"][:], recording["plan/focus_phase"][:]
    assert (0.01 <= loops.max() <= 0.02) == (group == "plan") and loops.max() <= 0.02
    assert (np.nanmax(phases, initial=0) > 0) == (group == "am")
