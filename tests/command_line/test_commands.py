"""Every command with good input: files that open, numbers that agree, the same result twice."""

import json
import math
import re

import h5py
import numpy as np
import pytest

from conftest import ROOT
from pictures import write_grey_png


def blob_field(rows=24, cols=30, cell=5.0):
    y, x = np.mgrid[0:rows, 0:cols] * cell
    p = np.exp(-((x - 60) ** 2 + (y - 60) ** 2) / (2 * 22.0**2)) + 0.7 * np.exp(
        -((x - 100) ** 2 + (y - 40) ** 2) / (2 * 12.0**2)
    )
    return {
        "format": "prostm-field/1",
        "cell_mm": cell,
        "origin_mm": [0, 0],
        "rows": rows,
        "cols": cols,
        "pressure": p.tolist(),
    }


@pytest.fixture
def field(tmp_path):
    path = tmp_path / "blob.json"
    path.write_text(json.dumps(blob_field()))
    return path


def plan_of(prostm, *args):
    done = prostm("plan", *args, "--json", "-")
    return json.loads(done.stdout)


def without_times(plan):
    return {k: v for k, v in plan.items() if k != "stage_us"}


def test_help_has_an_example(prostm):
    for command in ["run", "plan", "capture", "bench", "field", "solve", "devices", "selftest", "soak", "check", "settings",
                    "help"]:
        done = prostm(command, "--help")
        assert "Example:" in done.stdout


def test_plan_files_follow_the_design(prostm, field):
    plan = plan_of(prostm, field)
    assert plan["format"] == "prostm-plan/1" and plan["preset"] == "best" and plan["method"] == "pro-stm"
    assert 1 <= len(plan["paths"]) <= 4
    for path in plan["paths"]:
        points = np.array(path["points_mm"])
        length = np.linalg.norm(points - np.roll(points, -1, axis=0), axis=1).sum()
        assert length == pytest.approx(path["length_mm"], abs=1e-9) and length <= 140.5
        assert path["period_ms"] == pytest.approx(path["length_mm"] / path["speed_m_s"], rel=1e-12)
        assert len(path["pressure"]) == len(points) and min(path["pressure"]) >= 0
    assert set(plan["stage_us"]) == {"init", "kmeans", "tour", "split", "resample", "refine", "total"}
    assert set(plan["metrics"]) == {"rmse", "correlation", "coverage", "skill_0", "skill_8", "overlap", "spill"}
    assert set(plan["planned_metrics"]) == set(plan["metrics"]) and "metrics_at" not in plan
    assert plan["sigma_mm"] == 8.6
    assert plan["full_scale_pressure"] == pytest.approx(1.4 * np.max(blob_field()["pressure"]))
    paths = len(plan["paths"])
    assert plan["power"] == {"share_of_array": 1 / paths, "share_of_full_scale": 1.0, "limit": 4.0}
    assert plan["plane"]["origin_mm"] == [0, 0, 200]
    assert plan["settings"]["plan"]["draw_rate"] == 50


def test_quality_is_that_of_the_played_plan(prostm, field, tmp_path):
    plain = plan_of(prostm, field)
    for settings in ["power_limit = 0.5", "full_scale_pressure = 0.2", "fade_time = 0.02"]:
        (tmp_path / "emit.toml").write_text(f"[emit]\n{settings}\n")
        plan = plan_of(prostm, field, "--settings", tmp_path / "emit.toml")
        assert plan["metrics"]["rmse"] > 1.2 * plain["metrics"]["rmse"]
    out = prostm("plan", field).stdout
    assert "quality of what is played, by Eq. (1) with sigma 8.60 mm" in out


def test_the_same_field_twice_gives_the_same_plan(prostm, field):
    assert without_times(plan_of(prostm, field)) == without_times(plan_of(prostm, field))
    assert without_times(plan_of(prostm, field, "--seed", "5")) == without_times(plan_of(prostm, field, "--seed", "5"))


def test_a_stronger_field_gives_the_same_paths(prostm, field, tmp_path):
    strong = blob_field()
    strong["pressure"] = (1024 * np.array(strong["pressure"])).tolist()
    other = tmp_path / "strong.json"
    other.write_text(json.dumps(strong))
    a, b = plan_of(prostm, field), plan_of(prostm, other)
    for weak_path, strong_path in zip(a["paths"], b["paths"], strict=True):
        assert weak_path["points_mm"] == strong_path["points_mm"]
        assert [1024 * p for p in weak_path["pressure"]] == strong_path["pressure"]


def test_weights_attract_the_path_to_errors_that_count_more(prostm, field, tmp_path):
    two = blob_field()
    pressure = np.zeros((20, 40))
    pressure[8:12, 6:10] = pressure[8:12, 30:34] = 1
    weight = np.ones_like(pressure)
    weight[:, :20] = 3
    two.update(rows=20, cols=40, origin_mm=[0, 0], cell_mm=4, pressure=pressure.tolist(), weight=weight.tolist())
    two.pop("height_mm", None)
    path = tmp_path / "plate.json"
    path.write_text(json.dumps(two))
    settings = tmp_path / "one.toml"
    settings.write_text("[plan]\npaths = 1\n")
    plan = plan_of(prostm, path, "--settings", settings)
    assert np.mean(plan["paths"][0]["points_mm"], axis=0)[0] < 60
    assert "by the field's weights" in prostm("plan", path).stdout
    assert "by the field's weights" not in prostm("plan", field).stdout

    # if no pressure has a weight, there is nothing to plan
    two["weight"] = (pressure == 0).astype(int).tolist()
    path.write_text(json.dumps(two))
    assert "no pressure where its weight is above 0" in prostm("plan", path).stdout
    assert prostm("plan", path, "--preset", "paper").stdout.count("path ") > 1


def test_the_touch_settings_weight_a_captured_hand(prostm, refuses, tmp_path):
    finer = tmp_path / "finer.toml"
    finer.write_text("[contact]\ntouch_palm = 1\ntouch_finger = 3\ntouch_tip = 7\n")
    capture = ["capture", "--scene", "four-plumes", "--grid", "32", "--frames", "2", "--out"]
    prostm(*capture, tmp_path / "same.h5")
    prostm(*capture, tmp_path / "finer.h5", "--settings", finer)
    with h5py.File(tmp_path / "same.h5") as same, h5py.File(tmp_path / "finer.h5") as other:
        assert "weight" not in same["target"]
        weight, pressure = other["target/weight"][:], other["target/pressure"][:]
        np.testing.assert_array_equal(np.isnan(weight), np.isnan(pressure))
        assert 7 in weight and set(weight[~np.isnan(weight)]) <= {1, 3, 7}
        np.testing.assert_array_equal(pressure, same["target/pressure"][:])
    assert "by the field's weights" in prostm("plan", tmp_path / "finer.h5").stdout
    finer.write_text("[contact]\ntouch_tip = 0\n")
    refuses(*capture, tmp_path / "no.h5", "--settings", finer, words=["touch_tip = 0 must be between 0.001 and 1000"])


def test_every_field_format_gives_the_same_plan(prostm, field, tmp_path):
    pressure = np.array(blob_field()["pressure"])
    np.save(tmp_path / "blob.npy", pressure)
    from_json = plan_of(prostm, field)
    from_npy = plan_of(prostm, tmp_path / "blob.npy", "--cell-mm", "5")
    assert from_json["paths"] == from_npy["paths"]

    # a PNG has 8 bits: the field is rounded to them, with row 0 at the largest y
    grey = np.round(255 * pressure / pressure.max()).astype(np.uint8)
    write_grey_png(tmp_path / "blob.png", grey[::-1])
    np.save(tmp_path / "grey.npy", grey.astype(float))
    from_png = plan_of(prostm, tmp_path / "blob.png", "--cell-mm", "5")
    from_grey = plan_of(prostm, tmp_path / "grey.npy", "--cell-mm", "5")
    for a, b in zip(from_png["paths"], from_grey["paths"], strict=True):
        np.testing.assert_allclose(a["points_mm"], b["points_mm"], atol=1e-6)


def test_a_field_without_pressure_gives_no_path(prostm, tmp_path):
    empty = blob_field()
    empty["pressure"] = np.zeros((empty["rows"], empty["cols"])).tolist()
    path = tmp_path / "empty.json"
    path.write_text(json.dumps(empty))
    assert plan_of(prostm, path)["paths"] == []


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_plan_figure(prostm, field, tmp_path, ending):
    figure = tmp_path / f"panels.{ending}"
    prostm("plan", field, "--figure", figure)
    head = figure.read_bytes()[:100]
    assert head.startswith(b"\x89PNG") if ending == "png" else b"<svg" in head or b"<?xml" in head


def run_summary(prostm, *args):
    done = prostm("run", "--grid", "32", "--seconds", "8", *args, "--json", "-")
    return json.loads(done.stdout)


def finite_or_null(value):
    if isinstance(value, dict):
        return all(finite_or_null(v) for v in value.values())
    if isinstance(value, list):
        return all(finite_or_null(v) for v in value)
    return not isinstance(value, float) or math.isfinite(value)


def test_run_writes_a_recording_a_figure_and_a_summary(prostm, tmp_path):
    recording, figure = tmp_path / "run.h5", tmp_path / "run.png"
    summary = run_summary(prostm, "--as-fast-as-possible", "--record", recording, "--figure", figure)
    assert summary["format"] == "prostm-run/1" and finite_or_null(summary)
    assert summary["world_steps"] == 400 and summary["plans"] + summary["empty_updates"] == 200
    assert summary["blocks"] == 8000 and summary["missed_blocks"] == summary["limited_samples"] == 0
    assert summary["plans"] > 50
    assert summary["max_focus_step_mm"] <= 0.2 + 1e-6 and summary["max_path_length_mm"] <= 140.5
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert not list(tmp_path.glob("*.part*"))
    with h5py.File(recording) as h5:
        assert json.loads(h5.attrs["summary"])["plans"] == summary["plans"]
        assert h5.attrs["scene"] == "one-plume"


@pytest.mark.long
@pytest.mark.parametrize("options, seconds", [([], 8.0), (["--seconds", "9"], 9.0)])
def test_a_recording_sets_the_length_of_a_run(prostm, options, seconds):
    done = prostm("run", "--hand", ROOT / "data/wave.hands.jsonl", "--as-fast-as-possible", "--grid", "32", *options, "--json", "-")
    assert json.loads(done.stdout)["seconds"] == pytest.approx(seconds, abs=0.03)


@pytest.mark.long
def test_in_still_air_the_hand_feels_its_own_movement(prostm):
    still = run_summary(prostm, "--as-fast-as-possible", "--scene", "still-air")
    assert still["world_steps"] == 400 and still["plans"] > 50


@pytest.mark.long
def test_the_settings_of_the_am_papers_method(prostm):
    done = prostm("run", "--method", "am", "--settings", ROOT / "data/barreiro-2019.toml", "--stepped", "--seconds", "0.2",
                  "--json", "-")
    summary = json.loads(done.stdout)
    assert summary["world_steps"] == 18 and summary["plans"] + summary["empty_updates"] == 6
    fluid = summary["settings"]["fluid"]
    assert (fluid["solver"], fluid["hand"], fluid["width"] / fluid["cells"]) == ("jacobi", "voxels", pytest.approx(0.005))


@pytest.mark.long
@pytest.mark.parametrize("array", ["autd3", "plate.json"])
def test_run_plays_any_array(prostm, tmp_path, array):
    (tmp_path / "plate.json").write_text(json.dumps(PLATE))
    recording = tmp_path / "run.h5"
    run_summary(prostm, "--as-fast-as-possible", "--array", array, "--record", recording)
    with h5py.File(recording) as h5:
        pipeline = json.loads(h5.attrs["settings"])["pipeline"]
        assert pipeline["array"] == array and pipeline["array_width"] is True


@pytest.mark.parametrize("given, own_width", [
    ("[plan]\n", True), ("plan.sigma = 8.6e-3", False), ("am.sigma = 8.6e-3", True),
    ("pipeline.array_width = false", False), ("plan.sigma = 8.6e-3\npipeline.array_width = true", True)])
def test_a_run_uses_the_width_of_its_array_unless_another_is_given(prostm, tmp_path, given, own_width):
    (tmp_path / "s.toml").write_text(given)
    prostm("run", "--stepped", "--grid", "32", "--seconds", "0.1", "--settings", "s.toml", "--record", "run.h5")
    with h5py.File(tmp_path / "run.h5") as h5:
        settings = json.loads(h5.attrs["settings"])
    assert settings["pipeline"]["array_width"] is own_width and settings["plan"]["sigma"] == 8.6e-3


@pytest.mark.long
def test_threaded_and_stepped_runs_record_the_same(prostm, tmp_path):
    files = [tmp_path / "threaded.h5", tmp_path / "stepped.h5"]
    run_summary(prostm, "--as-fast-as-possible", "--record", files[0])
    run_summary(prostm, "--stepped", "--record", files[1])

    def everything(path):
        found = {}
        with h5py.File(path) as h5:
            h5.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return found

    threaded, stepped = everything(files[0]), everything(files[1])
    assert threaded.keys() == stepped.keys() and threaded
    for name in threaded:
        if "stage" in name:
            continue  # times
        np.testing.assert_array_equal(threaded[name], stepped[name], err_msg=name)


def test_capture_then_bench_then_plan_a_frame(prostm, tmp_path):
    recording = tmp_path / "fields.h5"
    done = prostm("capture", "--grid", "32", "--frames", "20", "--out", recording)
    done = prostm("bench", recording, "--repeats", "1", "--json", "-")
    rows = json.loads(done.stdout)
    assert rows and finite_or_null(rows)
    for row in rows:
        assert {"name", "unit", "n", "p50", "p99", "max", "baseline", "baseline_p50", "ratio"} <= set(row)
    plan = plan_of(prostm, recording, "--frame", "7")
    assert plan["paths"]


def test_devices_reports_the_capacity_of_a_link(prostm):
    rows = json.loads(prostm("devices", "--budget", "--json", "-").stdout)
    frames = {(row["slots"], row["divider"], round(row["block_ms"])): row["block_frames"] for row in rows}
    assert [frames[8, 5, ms] for ms in (10, 20, 40)] == [9, 18, 36]
    assert [frames[8, 6, ms] for ms in (10, 20, 40)] == [8, 15, 30]
    assert [frames[4, 2, ms] for ms in (10, 20, 40)] == [11, 22, 43]
    table = prostm("devices", "--budget").stdout
    assert "slots" in table and len(table.splitlines()) > 90


def test_devices_reports_untested_devices(prostm):
    done = prostm("devices", "--json", "-")
    kinds = {row["kind"]: row for row in json.loads(done.stdout)}
    assert kinds["sim"]["available"] and not kinds["ultraleap"]["available"]
    assert "never with real units" in kinds["autd3"]["detail"]
    assert "never tried" in kinds["ultraleap"]["detail"]
    assert {"scripted", "recording", "page", "leap", "openxr"} <= set(kinds)
    for kind in ("leap", "openxr"):
        assert kinds[kind]["role"] == "hand" and "never with" in kinds[kind]["detail"]
    assert kinds["leap"]["found"] or "UltraleapTrackingWebSocket" in kinds["leap"]["words"]


def test_settings_file_reaches_every_stage(prostm, field, tmp_path):
    toml = tmp_path / "s.toml"
    toml.write_text('[plan]\npreset = "paper"\npaths = 2\ndraw_rate = 70\n')
    plan = plan_of(prostm, field, "--settings", toml)
    assert plan["preset"] == "paper" and len(plan["paths"]) <= 2
    assert plan["settings"]["plan"]["draw_rate"] == 70 and all(path["length_mm"] < 110 for path in plan["paths"])


def test_the_power_of_many_paths_is_shared(prostm, tmp_path):
    field = blob_field()
    field["pressure"] = (0.1 + np.array(field["pressure"])).tolist()
    name, toml = tmp_path / "wide.json", tmp_path / "s.toml"
    name.write_text(json.dumps(field))
    toml.write_text("[plan]\npaths = 8\n[emit]\npower_limit = 1.5\n")
    plan = plan_of(prostm, name, "--settings", toml)
    paths = len(plan["paths"])
    assert paths > 2
    assert plan["power"] == {"share_of_array": 1 / paths, "share_of_full_scale": 1.5 / paths, "limit": 1.5}
    told = prostm("plan", name, "--settings", toml).stdout
    assert f"power: {paths} focal points at once, each with {100 / paths:.1f} % of the array's power" in told
    assert f"the power limit of 1.5 allows each {150 / paths:.1f} % of full scale" in told


PLATE = {
    "format": "prostm-array/1",
    "name": "plate",
    "frequency_hz": 40000,
    "radius_mm": 4.5,
    "directivity": "omni",
    "amplitude_pa_m": 3.4,
    "transducers_mm": [[10 * x, 10 * y, 0] for x in range(-8, 8) for y in range(-8, 8)],
}
FOCI = {
    "format": "prostm-foci/1",
    "foci": [
        {"position_mm": [20, -10, 200], "pressure_pa": 800},
        {"position_mm": [-20, 10, 180], "pressure_pa": 400},
    ],
}


@pytest.mark.parametrize("array", ["usx", "autd3", "plate.json"])
@pytest.mark.parametrize("solver", ["superposition", "ibp", "gs-pat", "weighted", "eigenvector", "lm"])
def test_solve(prostm, tmp_path, array, solver):
    (tmp_path / "foci.json").write_text(json.dumps(FOCI))
    (tmp_path / "plate.json").write_text(json.dumps(PLATE))
    out = prostm("solve", "foci.json", "--array", array, "--solver", solver, "--json", "-").stdout
    result = json.loads(out)
    assert all(0 <= amplitude <= 1 for amplitude, _ in result["drives"])
    assert len(result["drives"]) == len(result["transducers_mm"]) == {"usx": 256, "autd3": 249, "plate.json": 256}[array]
    # one factor for both: together they reach the requested pressures
    asked = np.array([800, 400])
    assert asked @ result["reached_pa"] == pytest.approx(result["level"] * asked @ asked)
    if solver in ("weighted", "lm"):
        assert result["reached_pa"] == pytest.approx([800, 400], rel=1e-3)
    assert prostm("solve", "foci.json", "--array", array, "--solver", solver, "--json", "-").stdout == out


def test_am_plans_foci(prostm, field, tmp_path):
    figure = tmp_path / "am.svg"
    plan = plan_of(prostm, field, "--method", "am", "--figure", figure)
    assert plan["format"] == "prostm-plan/1" and plan["method"] == "am"
    assert "paths" not in plan and "preset" not in plan
    assert len(plan["foci"]) == 4
    for focus in plan["foci"]:
        assert set(focus) == {"patch", "position_mm", "pressure"} and focus["pressure"] > 0
    assert figure.read_text().startswith("<?xml")
    # the model: p φ of the nearest focus
    pressure = np.array(blob_field()["pressure"])
    y, x = np.mgrid[0:24, 0:30] * 5.0
    at = np.array([focus["position_mm"] for focus in plan["foci"]])
    square = (x[..., None] - at[:, 0]) ** 2 + (y[..., None] - at[:, 1]) ** 2
    nearest = square.argmin(axis=-1)
    phi = np.exp(-square.min(axis=-1) / (2 * 8.6**2))
    for k, focus in enumerate(plan["foci"]):
        own = nearest == k
        expected = (pressure[own] * phi[own]).sum() / (phi[own] ** 2).sum()
        assert focus["pressure"] == pytest.approx(expected, rel=1e-9)
    rendered = np.array([focus["pressure"] for focus in plan["foci"]])[nearest] * phi
    rmse = np.sqrt(((rendered - pressure) ** 2).mean()) / pressure.max()
    assert plan["planned_metrics"]["rmse"] == pytest.approx(rmse, rel=1e-9)
    assert plan["metrics"]["rmse"] == pytest.approx(rmse, rel=0.01)  # full scale clips a little
    names = [control["name"] for control in plan["controls"]]
    assert "random foci, solved pressures" in names and "foci of another target" in names

    settings = tmp_path / "am.toml"
    settings.write_text('[pipeline]\nmethod = "am"\n[am]\nfoci = 2\nsigma = 0.016\n')
    wide = plan_of(prostm, field, "--settings", settings)
    assert len(wide["foci"]) == 2 and wide["settings"]["am"]["sigma"] == 0.016
    assert "focus 1: at" in prostm("plan", field, "--method", "am", "--paths", "3").stdout


def test_am_finds_no_foci_without_pressure(prostm, tmp_path):
    empty = blob_field()
    empty["pressure"] = (0 * np.array(empty["pressure"])).tolist()
    path = tmp_path / "empty.json"
    path.write_text(json.dumps(empty))
    assert "no pressure anywhere, so no focus" in prostm("plan", path, "--method", "am").stdout


@pytest.mark.long
def test_am_runs_and_records_foci(prostm, tmp_path):
    files = [tmp_path / "threaded.h5", tmp_path / "stepped.h5"]
    figure = tmp_path / "am.png"
    summary = run_summary(prostm, "--method", "am", "--as-fast-as-possible", "--record", files[0], "--figure", figure)
    assert summary["method"] == "am" and finite_or_null(summary)
    assert summary["plans"] + summary["empty_updates"] == 400  # one update per fluid step: 50 Hz
    assert summary["plans"] > 100 and summary["max_focus_step_mm"] == 0 and summary["stage_ms"]["plan"]["p50"] < 4
    # the frame's own step, the zero of the envelope, and the device
    assert summary["latency_ms"]["p99"] < 40
    assert figure.read_bytes().startswith(b"\x89PNG")
    run_summary(prostm, "--method", "am", "--stepped", "--record", files[1])
    with h5py.File(files[0]) as a, h5py.File(files[1]) as b:
        for name in ["foci", "focus_patch", "focus_position", "focus_pressure", "paths"]:
            np.testing.assert_array_equal(a["plan"][name][()], b["plan"][name][()], err_msg=name)
        foci = a["plan/foci"][()]
        assert foci.max() == 4 and foci.min() == -1
        i = foci.argmax()
        assert np.isfinite(a["plan/focus_position"][i, :4]).all() and np.isnan(a["plan/focus_position"][i, 4:]).all()
        assert (a["plan/focus_pressure"][i, :4] > 0).all() and a["plan/paths"][i] == 0


@pytest.mark.realtime
def test_am_keeps_real_time(prostm):
    summary = run_summary(prostm, "--method", "am", "--realtime")
    assert summary["plans"] > 10 and summary["max_focus_step_mm"] == 0


def test_bench_has_the_row_of_am(prostm, tmp_path):
    recording = tmp_path / "fields.h5"
    prostm("capture", "--grid", "32", "--frames", "5", "--out", recording)
    rows = json.loads(prostm("bench", recording, "--repeats", "1", "--json", "-").stdout)
    row = rows[-1]
    assert row["name"].endswith("am total") and row["baseline_p50"] == 4000 and row["ratio"] > 1
    done = prostm("bench", recording, "--repeats", "1", "--method", "am")
    assert "updates a second" in done.stdout and "textbook" not in done.stdout


@pytest.mark.long
def test_field_of_a_plan(prostm, field, tmp_path):
    prostm("plan", field, "--json", "plan.json")
    out = prostm("field", "plan.json", "--field", field, "--figure", "f.png", "--json", "-").stdout
    result = json.loads(out)
    assert (tmp_path / "f.png").read_bytes().startswith(b"\x89PNG")
    envelope, mean = np.array(result["envelope_pa"]), np.array(result["mean_pa"])
    assert envelope.shape == mean.shape == (24, 30)
    # the largest values lie between the cells' centres
    assert 1.0 <= result["envelope"]["largest_pa"] / envelope.max() < 1.1
    assert 1.0 <= result["mean"]["largest_pa"] / mean.max() < 1.1
    assert np.all(envelope >= mean) and envelope.max() > 3 * mean.max() > 0
    # both have the shape of the target, and of both foci
    assert result["envelope"]["metrics"]["correlation"] > 0.6 and result["mean"]["metrics"]["skill_8"] > 0.4
    assert set(result["envelope"]["metrics"]) == {"rmse", "correlation", "coverage", "skill_0", "skill_8", "overlap", "spill"}
    felt = result["felt"]
    assert np.array(result["felt_um"]).max() == pytest.approx(felt["largest_um"]) and felt["intensity_um"] > 0
    assert felt["metrics"]["skill_8"] > 0.2 and 0 <= felt["strongest_ghost"] <= 1 and felt["ghosts"] >= 0
    assert result["drives"]["short_samples"] == 0 and result["drives"]["largest_drive"] == pytest.approx(1)
    assert 0 < result["drives"]["mean_power"] < 256
    assert 0.5 < result["foci"]["mean_offset_mm"] < 2.5  # transducers lag
    assert max(map(abs, result["loop"]["stretch"])) < 0.05
    assert prostm("field", "plan.json", "--field", field, "--json", "-").stdout == out

    quick = json.loads(prostm("field", "plan.json", "--memoryless", "--array", "autd3", "--json", "-").stdout)
    assert quick["foci"]["mean_offset_mm"] < 0.8 * result["foci"]["mean_offset_mm"]
    assert quick["felt"]["metrics"] is None and quick["felt"]["ghosts"] is None and quick["felt"]["largest_um"] > 0
    assert quick["envelope"]["metrics"] is None and quick["array"] == "autd3"
    told = prostm("field", "plan.json", "--field", field).stdout
    assert "for comparison only" in told and "largest side lobe" in told

    # with an array the percept of a plan is always reported
    told = prostm("plan", field, "--array", "usx", "--json", "felt.json").stdout
    plan = json.loads((tmp_path / "felt.json").read_text())
    assert " felt" in told and "felt_skill" not in plan["planned_metrics"]
    assert all("felt_skill" not in control["metrics"] for control in plan["controls"])
    felt = json.loads(prostm("field", "felt.json", "--field", field, "--json", "-").stdout)["felt"]
    assert plan["metrics"]["felt_skill"] == pytest.approx(felt["metrics"]["skill_8"], abs=0.01)

    prostm("plan", field, "--method", "am", "--json", "foci.json")
    am = json.loads(prostm("field", "foci.json", "--field", field, "--figure", "am.png", "--json", "-").stdout)
    assert am["loop"]["laps"] == [0, 0, 0, 0] and am["loop"]["duration_ms"] == 5
    assert am["envelope"]["metrics"]["correlation"] > 0.2


@pytest.mark.long
def test_plans_in_step_and_foci_with_phases_have_fields(prostm, field, tmp_path):
    prostm("plan", field, "--json", "plan.json")
    plan = json.loads((tmp_path / "plan.json").read_text())
    plan["loop_ms"] = 40
    for path, laps in zip(plan["paths"], [1, 2, 1, 2]):
        path["speed_m_s"] = path["length_mm"] * laps / 40
        path.pop("period_ms")
    (tmp_path / "step.json").write_text(json.dumps(plan))
    step = json.loads(prostm("field", "step.json", "--memoryless", "--json", "-").stdout)
    assert step["loop"]["samples"] == 1600 and step["loop"]["duration_ms"] == 40
    assert step["loop"]["laps"] == [1, 2, 1, 2][: len(plan["paths"])] and set(step["loop"]["stretch"]) == {0}

    prostm("plan", field, "--method", "am", "--json", "foci.json")
    same = json.loads(prostm("field", "foci.json", "--memoryless", "--json", "-").stdout)
    foci = json.loads((tmp_path / "foci.json").read_text())
    for k, focus in enumerate(foci["foci"]):
        focus["phase"] = 0.25 * k
    (tmp_path / "late.json").write_text(json.dumps(foci))
    late = json.loads(prostm("field", "late.json", "--memoryless", "--json", "-").stdout)
    assert late["loop"] == same["loop"] and late["felt_um"] != same["felt_um"]


@pytest.mark.long
def test_an_unreachable_full_scale_is_reported(prostm, field):
    prostm("plan", field, "--json", "plan.json")
    quiet, loud = (json.loads(prostm("field", "plan.json", "--full-scale-pa", p, "--json", "-").stdout) for p in (100, 1e5))
    assert quiet["drives"]["short_samples"] == 0 and quiet["drives"]["full_scale_pa"] == 100
    assert loud["drives"]["short_samples"] == loud["loop"]["samples"]
    twice = json.loads(prostm("field", "plan.json", "--full-scale-pa", 200, "--json", "-").stdout)
    np.testing.assert_allclose(np.array(twice["mean_pa"]), 4 * np.array(quiet["mean_pa"]), rtol=1e-3, atol=1e-6)


@pytest.mark.long
def test_widths_of_a_focus(prostm, field, tmp_path):
    rows = json.loads(prostm("field", "--widths", "--json", "-").stdout)["widths"]
    width = {(r["height_mm"], r["offset_mm"], round(r["tilt_deg"])): r for r in rows}
    assert len(width) == 5 * 4 * 4
    assert width[200, 0, 0]["sigma_along_mm"] == pytest.approx(4.3, abs=0.3)
    assert width[300, 0, 0]["sigma_along_mm"] == pytest.approx(6.1, abs=0.3)
    assert "sigma" in prostm("field", "--widths", "--array", "autd3").stdout
    plan = plan_of(prostm, field, "--array", "usx")
    assert 4e-3 < plan["settings"]["plan"]["sigma"] < 8e-3
    assert plan["sigma_mm"] == pytest.approx(1e3 * plan["settings"]["plan"]["sigma"])
    [at] = plan["metrics_at"]
    assert at["sigma_mm"] == 8.6 and at["metrics"]["rmse"] != plan["metrics"]["rmse"]
    # the paper's presets keep their width, and report metrics at the array's width
    paper = plan_of(prostm, field, "--array", "usx", "--preset", "paper-valid")
    assert paper["sigma_mm"] == 8.6 and paper["metrics_at"][0]["sigma_mm"] == pytest.approx(plan["sigma_mm"])
    assert "focus of usx on the skin" in prostm("plan", field, "--array", "usx").stdout


@pytest.mark.parametrize("shape", [(1, 20), (20, 1), (1, 1)])
@pytest.mark.parametrize("method", ["pro-stm", "am"])
def test_a_raster_of_one_row_or_column_works_in_every_command(prostm, tmp_path, shape, method):
    np.save(tmp_path / "line.npy", np.ones(shape))
    line = ["line.npy", "--cell-mm", "5"]
    prostm("plan", *line, "--method", method, "--json", "plan.json", "--figure", "plan.svg", "--array", "usx")
    done = prostm("field", "plan.json", "--field", *line, "--json", "-", "--figure", "field.svg")
    field = json.loads(done.stdout)
    assert np.array(field["envelope_pa"]).shape == shape and np.array(field["felt_um"]).shape == shape
    assert 0 < np.max(field["felt_um"]) and field["envelope"]["largest_pa"] > 0


def test_the_plan_of_the_documentation_has_a_field(prostm, tmp_path):
    text = (ROOT / "docs" / "reference" / "files.md").read_text()
    example = text[text.index('{"format": "prostm-plan/1"'):]
    (tmp_path / "plan.json").write_text(example[: example.index("```")])
    assert "radiation pressure on the skin" in prostm("field", "plan.json").stdout


def test_the_program_is_not_compiled_for_a_particular_machine(program):
    """Code for newer machines is selected at run time, not by compiler options."""
    commands = json.loads((program.parent / "compile_commands.json").read_text())
    # only benchmarks, which are not installed, may be compiled for the build machine
    mine = [c for c in commands if "/bench/" not in c["file"]]
    assert any("/textbook/" in c["file"] for c in mine) and any("/apps/" in c["file"] for c in mine)
    assert [c["file"] for c in mine if re.search(r" -m(arch|cpu|tune|avx|sse|fma)", c["command"])] == []


def test_a_study_hand_has_its_own_size_and_others_do_not(prostm, refuses, tmp_path):
    areas = []
    for size in ("0.8", "1.2"):
        out = tmp_path / f"{size}.h5"
        prostm("capture", "--hand", "study", "--hand-size", size, "--frames", "2", "--grid", "32", "--out", out)
        with h5py.File(out) as file:
            areas.append(int(np.isfinite(file["target/pressure"][:]).sum()))
    assert 1.8 < areas[1] / areas[0] < 2.8  # the square of 1.5
    refuses("run", "--hand", "scripted", "--hand-size", "0.9", words=["--hand-size belongs to --hand study"])
    refuses("capture", "--hand", "study", "--hand-size", "2", "--frames", "1", "--out", "x.h5", words=["0.7", "1.3"])


def test_answers_are_analysed(prostm, tmp_path):
    answers = ROOT / "data" / "made-up-answers.csv"
    said = prostm("study", "analyse", answers, "--json", "analysis.json").stdout
    assert said.startswith("16 participants, each with one method\n") and said.endswith("wrote analysis.json\n")
    analysis = json.loads((tmp_path / "analysis.json").read_text())
    assert analysis["format"] == "prostm-analysis/1" and analysis["groups"] == "between"
    assert [scene["scene"] for scene in analysis["scenes"]] == [None, "one-plume", "four-plumes"]
    rows = [line.split(",") for line in answers.read_text().splitlines()[1:]]
    for method in analysis["scenes"][0]["methods"]:
        mine = [int(row[6]) for row in rows if row[2] == method["method"]]
        assert (method["correct"], method["answers"]) == (sum(mine), len(mine))
    assert " ".join(said.split()).count(analysis["words"]) == 1
    # each participant with both methods
    pairs = [line.replace("S", "A", 1) if line.startswith("S") else line for line in answers.read_text().splitlines()]
    (tmp_path / "within.csv").write_text("\n".join(line.replace("trial", "note", 1) for line in pairs))
    assert "8 participants, each with all methods" in prostm("study", "analyse", "within.csv").stdout
