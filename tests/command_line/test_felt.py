"""Plans that optimise the felt field, and how strongly stimuli are felt."""

import json
import re

import h5py
import numpy as np
import pytest

from conftest import ROOT

FIELD = ROOT / "data" / "four-plumes.json"
LEVEL = re.compile(r"^  felt strength:? +about (\d+) dB (above|below) the threshold of touch \((-?\d+) to (-?\d+) dB\): ",
                  re.MULTILINE)


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


def test_the_percept_chooses_nothing_by_default(prostm):
    rows = json.loads(prostm("settings", "felt_weight", "--json", "-").stdout)["settings"]
    assert [(row["group"], row["value"], row["least"], row["most"]) for row in rows] == [("am", 0, 0, 1)]
    assert "0: off" in rows[0]["help"]
    for method in ("pro-stm", "am"):
        text = prostm("plan", FIELD, "--method", method).stdout
        assert "in step" not in text and "nobody has felt" not in text and "late" not in text
    assert "loop_ms" not in plan_of(prostm)


@pytest.mark.long
def test_the_preset_reports_what_it_chose(prostm, settings):
    text = prostm("plan", FIELD, "--preset", "felt").stdout
    plan = plan_of(prostm, "--preset", "felt")
    assert line_with(text, "nobody has felt it") == (
        f"  in step: all paths come round together every {plan['loop_ms']:.1f} ms; number of paths, points and pressures "
        "chosen by what the model of the skin feels (plan.strength_weight 0.1); nobody has felt it")
    assert 10 <= plan["loop_ms"] <= 20
    for path in plan["paths"]:
        laps = plan["loop_ms"] / path["period_ms"]
        assert laps == pytest.approx(round(laps), abs=1e-9) and path["speed_m_s"] <= 7 * (1 + 1e-9)
    stronger = plan_of(prostm, "--preset", "felt", "--array", "usx", "--settings",
                       settings("[plan]\nstrength_weight = 5\n"))
    assert len(stronger["paths"]) == 1 <= len(plan["paths"]) <= 4


@pytest.mark.parametrize("text, line, name", [
    ("[plan]\nfelt_weight = 0.9\n", 2, "felt_weight"),
    ('[plan]\npreset = "fast"\nfelt_points = true\n', 3, "felt_points"),
])
def test_settings_of_earlier_versions_select_the_preset_with_a_warning(prostm, settings, text, line, name):
    done = prostm("plan", FIELD, "--settings", settings(text), "--budget-ms", "20", "--json", "plan.json")
    assert done.stderr.startswith(
        f'prostm: warning: s.toml, line {line}: plan.{name} was replaced by preset "felt", which is used\n')
    assert done.stderr.count("warning: s.toml") == 1 and "plan.strength_weight" in done.stdout
    done = prostm("plan", FIELD, "--settings", "s.toml", "--preset", "fast", "--json", "-")
    assert json.loads(done.stdout)["settings"]["plan"]["preset"] == "fast"


def test_settings_of_earlier_versions_that_were_off_have_no_effect(prostm, settings):
    file = settings("[plan]\nfelt_weight = 0\nfelt_points = false\n")
    done = prostm("plan", FIELD, "--settings", file, "--json", "-")
    assert "replaced" not in done.stderr
    assert json.loads(done.stdout)["paths"] == plan_of(prostm)["paths"]


def test_am_reports_it_too(prostm, settings):
    file = settings("[am]\nfelt_weight = 0.5\n")
    text = prostm("plan", FIELD, "--method", "am", "--settings", file).stdout
    assert line_with(text, "nobody has felt it") == (
        "  pressures and phases chosen by what the model of the skin feels (am.felt_weight 0.5); nobody has felt it")
    assert re.search(r"focus \d: .*% of a period late", text)
    assert "felt it" not in prostm("plan", FIELD, "--settings", file).stdout


@pytest.mark.long
def test_with_an_array_the_verdict_is_about_the_felt_field(prostm):
    metrics = plan_of(prostm, "--array", "usx", "--preset", "felt")["metrics"]
    lines = prostm("plan", FIELD, "--array", "usx", "--preset", "felt").stdout.splitlines()
    assert lines[1] == "4 paths render this field; a shape of 1 is perfect, 0 is no better than an even field"
    assert lines[2] == f"  shape by Eq. (1)   {metrics['skill_0']:.2f}"
    assert lines[3] == f"  felt shape         {metrics['felt_skill']:.2f}"
    assert LEVEL.match(lines[4]) and int(level_in(lines[4])[0]) == round(metrics["sensation_level"])
    assert lines[5] == f"  spill              {metrics['spill']:.3f}"
    metrics = plan_of(prostm, "--preset", "felt")["metrics"]
    lines = prostm("plan", FIELD, "--preset", "felt").stdout.splitlines()
    assert lines[2:5] == [f"  shape by Eq. (1)   {metrics['skill_0']:.2f}",
                          "  felt shape         not computed without --array",
                          f"  spill              {metrics['spill']:.3f}"]


def test_a_percept_beyond_the_models_limits_has_its_reason(prostm, tmp_path):
    y, x = np.mgrid[0:140, 0:140]
    np.save(tmp_path / "fine.npy", np.exp(-((x - 70.0) ** 2 + (y - 60.0) ** 2) / 200))
    text = prostm("plan", "fine.npy", "--cell-mm", "1", "--array", "usx").stdout
    assert "more than 128 cells along an edge" in line_with(text, "  felt shape  ")
    assert "without --array" not in text and "felt strength" not in text


def test_a_pressure_field_that_loses_to_a_control_does_not_imply_that_the_felt_field_does(prostm, settings):
    palm = [ROOT / "data" / "palm.npy", "--cell-mm", "5", "--method", "am"]
    warning = line_with(prostm("plan", *palm).stdout, "loses to the control")
    assert warning.endswith(": the percept will hardly resemble the field")
    warning = line_with(prostm("plan", *palm, "--settings", settings("[am]\nfelt_weight = 1\n")).stdout, "loses to")
    assert warning.endswith(": its pressure hardly resembles the field")


@pytest.mark.long
def test_the_arrays_own_field_is_felt_more_like_the_target(prostm):
    lack = {}
    for preset in ("best", "felt"):
        lack[preset] = 1 - plan_of(prostm, "--array", "usx", "--preset", preset)["metrics"]["felt_skill"]
    assert lack["felt"] < 0.7 * lack["best"]


@pytest.mark.parametrize("text, options, words", [
    ("[plan]\nfelt_weight = 1.5\n", [], "s.toml, line 2: plan.felt_weight = 1.5 must be between 0 and 1"),
    ("[plan]\nfelt_weight = -0.1\n", [], "plan.felt_weight = -0.1 must be between 0 and 1"),
    ("[plan]\nfelt_weight = nan\n", [], "s.toml, line 2: plan.felt_weight must be finite"),
    ("[am]\nfelt_weight = 2\n", ["--method", "am"], "am.felt_weight = 2 must be between 0 and 1"),
    ('[plan]\nfelt_weight = "much"\n', [], "s.toml, line 2: plan.felt_weight must be a number"),
    ("[am]\nfelt_wieght = 0.9\n", [], "felt_weight"),
    ('[plan]\nfelt_weight = 0.9\npreset = "paper"\n', [],
     "s.toml: plan.felt_weight selects preset felt, but the preset is paper: remove one of them"),
])
def test_invalid_options_are_rejected(refuses, settings, text, options, words):
    refuses("plan", FIELD, "--settings", settings(text), *options, words=[words])


@pytest.mark.parametrize("text, method, words", [
    ('[plan]\npreset = "felt"\n', "pro-stm", "(plan.strength_weight 0.1)"),
    ("[am]\nfelt_weight = 0.9\n", "am", "(am.felt_weight 0.9)"),
])
def test_a_run_plays_such_plans(prostm, settings, tmp_path, text, method, words):
    done = prostm("run", "--settings", settings(text), "--method", method, "--grid", "32", "--seconds", "1.5", "--stepped",
                  "--record", "run.h5")
    assert f"{words}; nobody has felt it" in line_with(done.stdout, "nobody has felt it")
    with h5py.File(tmp_path / "run.h5") as recording:
        loops, phases = recording["plan/loop"][:], recording["plan/focus_phase"][:]
    assert (0.01 <= loops.max() <= 0.02) == (method == "pro-stm") and loops.max() <= 0.02
    assert (np.nanmax(phases, initial=0) > 0) == (method == "am")



@pytest.fixture
def planned(prostm, tmp_path):
    """The text and the file of a plan made for an array."""
    done = prostm("plan", FIELD, "--preset", "fast", "--array", "usx", "--json", "plan.json")
    return done.stdout, json.loads((tmp_path / "plan.json").read_text())


def level_in(text):
    found = LEVEL.search(text)
    assert found, text
    return int(found[1]) * (-1 if found[2] == "below" else 1), int(found[3]), int(found[4])


@pytest.mark.long
def test_a_plan_states_its_level_and_interval(planned):
    text, plan = planned
    sensation = plan["sensation"]
    level, low, high = level_in(text)
    assert level == pytest.approx(sensation["level_db"], abs=0.5)
    assert [low, high] == pytest.approx(sensation["interval_db"], abs=0.5)
    assert sensation["sound"] == "measured" and "nominal" not in text
    assert plan["metrics"]["sensation_level"] == sensation["level_db"]
    assert -20 < sensation["level_db"] < 20


def test_a_plan_without_an_array_has_none(prostm):
    done = prostm("plan", FIELD, "--preset", "fast", "--json", "-")
    assert "sensation" not in json.loads(done.stdout) and not LEVEL.search(done.stderr)


@pytest.mark.long
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
    # a sound pressure that is given is taken as it is; below its limit the nominal array reaches it
    loop = json.loads(prostm("field", "plan.json", "--json", "-").stdout)
    given = json.loads(prostm("field", "plan.json", "--full-scale-pa", loop["drives"]["full_scale_pa"],
                              "--json", "-").stdout)["felt"]
    assert given["sensation"]["sound"] == "given"
    assert given["sensation"]["level_db"] == pytest.approx(loop["felt"]["sensation"]["level_db"] + 19.66, abs=0.1)
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
        assert sensation["sound"] == name and ("no sound level" in text) == (not measured)
        levels[name] = sensation["level_db"]
    assert levels["measured"] == pytest.approx(levels["nominal"] - 12.04, abs=0.01)


@pytest.mark.long
def test_a_run_reports_the_median_of_its_plans(prostm, tmp_path):
    def run(scene, seconds="6"):
        text = prostm("run", "--hand", "scripted", "--grid", "32", "--preset", "fast", "--seconds", seconds, "--stepped",
                      "--scene", scene, "--json", "run.json").stdout
        return text, json.loads((tmp_path / "run.json").read_text())["sensation"]

    text, plumes = run("four-plumes")
    assert 1 <= plumes["plans"] <= 5 and plumes["sound"] == "measured"
    assert plumes["lowest_db"] <= plumes["level_db"] <= plumes["highest_db"]
    assert level_in(text)[0] == pytest.approx(plumes["level_db"], abs=0.5)
    assert run("four-plumes", "3")[1] is None  # too short
    # in still air only the hand's own movement presses
    assert run("still-air")[1]["level_db"] < plumes["level_db"] - 6


@pytest.mark.long
def test_a_plan_names_fewer_paths_if_they_are_felt_better(prostm, tmp_path):
    y, x = np.mgrid[0:30, 0:30] * 5e-3 - 0.0725
    np.save(tmp_path / "line.npy", np.exp(-((x / 0.006) ** 2) / 2) * (abs(y) < 0.04))

    def plan(*options):
        text = prostm("plan", "line.npy", "--cell-mm", "5", "--array", "usx", *options, "--json", "plan.json").stdout
        return text, json.loads((tmp_path / "plan.json").read_text())["metrics"]

    text, four = plan()
    advice = re.search(r"^  1 path is felt better than 4: felt shape (.*) instead of (.*), and (\d+) dB stronger; try "
                       r"--paths 1 or --preset felt$", text, re.MULTILINE)
    text, one = plan("--paths", "1")
    assert "felt better than" not in text
    assert advice.groups() == (f"{one['felt_skill']:.2f}", f"{four['felt_skill']:.2f}",
                               f"{one['sensation_level'] - four['sensation_level']:.0f}")
    assert "felt better than" not in prostm("plan", FIELD, "--array", "usx", "--preset", "felt").stdout


@pytest.mark.long
def test_a_run_reports_its_quality_in_the_same_four_numbers(prostm, tmp_path):
    text = prostm("run", "--hand", "study", "--grid", "32", "--preset", "fast", "--seconds", "6", "--stepped",
                  "--scene", "four-plumes", "--json", "run.json", "--record", "run.h5").stdout
    quality = json.loads((tmp_path / "run.json").read_text())["quality"]
    lines = text.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("Quality of the plans")) + 1
    names = ["shape by Eq. (1)", "felt shape", "felt strength", "spill"]
    assert [line[2:20].strip() for line in lines[first:first + 4]] == names
    assert quality["plans"] == 5
    for line, metric, digits in ((0, "skill_0", 2), (1, "felt_skill", 2), (3, "spill", 3)):
        median, low, high = (f"{quality[metric][name]:.{digits}f}" for name in ("median", "lowest", "highest"))
        assert lines[first + line].endswith(f"{median} ({low} to {high})")
    # a plan of the recording, made again, is as good as the run's
    shapes = [json.loads(prostm("plan", "run.h5", "--frame", str(frame), "--preset", "fast", "--array", "usx",
                                "--json", "-").stdout)["metrics"]["skill_0"] for frame in (60, 100, 140)]
    assert quality["skill_0"]["lowest"] - 0.1 <= min(shapes) and max(shapes) <= quality["skill_0"]["highest"] + 0.1
