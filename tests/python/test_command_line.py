"""The module and the command line have the same planner: equal fields give bitwise equal numbers."""

import json

import numpy as np
import prostm
import pytest

from conftest import blobs, shared_file

def assert_same_plan(result, document):
    """Checks that a PlanResult and a plan file have the same paths, metrics and counts."""
    text = prostm.plan_to_json(result.plan, result.target, result.settings)
    assert json.loads(text)["paths"] == document["paths"] != []
    # Python has the numbers as written, except for the conversion from millimetres to metres, which may round
    for path, saved in zip(result.paths, document["paths"], strict=True):
        np.testing.assert_allclose(path.points, np.array(saved["points_mm"]) / 1000, rtol=3e-16, atol=0)
        np.testing.assert_array_equal(path.pressure, saved["pressure"])
        assert path.length == pytest.approx(saved["length_mm"] / 1000, rel=3e-16)
        assert path.speed == saved["speed_m_s"] and path.patch == saved["patch"]
        assert path.period == pytest.approx(saved["period_ms"] / 1000, rel=3e-16)
    assert result.metrics().as_dict() == document["metrics"]
    stats = result.stats.as_dict()
    assert {name: stats[name] for name in document["counts"]} == document["counts"]
    assert {name: stats[name] for name in document["violations"]} == document["violations"]


@pytest.mark.parametrize("preset", ["paper", "paper-valid", "best", "fast", "felt"])
def test_an_array_is_planned_like_its_file(program, tmp_path, pressure, preset):
    np.save(tmp_path / "field.npy", pressure)
    program("plan", tmp_path / "field.npy", "--cell-mm", 5, "--preset", preset, "--json", tmp_path / "plan.json")
    document = json.loads((tmp_path / "plan.json").read_text())
    assert_same_plan(prostm.plan(pressure, preset, cell_mm=5), document)
    assert_same_plan(prostm.plan(pressure, preset, cell=0.005), document)
    assert_same_plan(prostm.plan(tmp_path / "field.npy", preset, cell_mm=5), document)


def test_the_controls_match_the_command_line(program, tmp_path, pressure, field):
    np.save(tmp_path / "field.npy", pressure)
    program("plan", tmp_path / "field.npy", "--cell-mm", 5, "--json", tmp_path / "plan.json")
    saved = json.loads((tmp_path / "plan.json").read_text())["controls"]
    ours = prostm.controls(field)
    assert [c.name for c in ours] == [c["name"] for c in saved[:3]]
    assert [c.metrics.as_dict() for c in ours] == [c["metrics"] for c in saved[:3]]
    assert len(prostm.controls(field, other=prostm.plan(field).plan)) == 4


def test_settings_match_a_settings_file(program, tmp_path, pressure):
    np.save(tmp_path / "field.npy", pressure)
    (tmp_path / "s.toml").write_text("[plan]\npaths = 3\ndraw_rate = 70\ngain_exponent = 0.5\nsigma = 6e-3\nseed = 7\n")
    program("plan", tmp_path / "field.npy", "--cell-mm", 5, "--settings", tmp_path / "s.toml", "--json",
            tmp_path / "plan.json")
    document = json.loads((tmp_path / "plan.json").read_text())
    result = prostm.plan(pressure, cell_mm=5, paths=3, draw_rate=70, gain_exponent=0.5, sigma=6e-3, seed=7)
    assert_same_plan(result, document)
    assert result.settings.as_dict() == document["settings"]["plan"]


@pytest.mark.parametrize("preset", ["paper", "paper-valid"])
def test_the_papers_figure_2(program, tmp_path, preset):
    name = shared_file("data/paper/fig2.field.json")
    program("plan", name, "--preset", preset, "--json", tmp_path / "plan.json")
    document = json.loads((tmp_path / "plan.json").read_text())
    assert_same_plan(prostm.plan(name, preset), document)

    # the same field from its numbers
    saved = json.loads(name.read_text())
    pressure = np.array(saved["pressure"], dtype=float)
    field = prostm.TargetField(pressure, cell_mm=saved["cell_mm"], origin=np.array(saved["origin_mm"]) / 1000)
    assert_same_plan(prostm.plan(field, preset), document)


def test_fields_written_here_are_read_there_and_back(program, tmp_path, field):
    prostm.write_field(tmp_path / "field.json", field)
    program("plan", tmp_path / "field.json", "--json", tmp_path / "plan.json")
    assert_same_plan(prostm.plan(field), json.loads((tmp_path / "plan.json").read_text()))
    again = prostm.read_field(tmp_path / "field.json")
    for name in ["pressure", "skin", "height", "origin", "X_DP", "cell"]:
        np.testing.assert_array_equal(getattr(again, name), getattr(field, name))


def test_plans_written_here_and_there_are_the_same_file(program, tmp_path, field):
    prostm.write_field(tmp_path / "field.json", field)
    program("plan", tmp_path / "field.json", "--json", tmp_path / "there.json")
    result = prostm.plan(field)
    result.write(tmp_path / "here.json")
    here, there = (json.loads((tmp_path / name).read_text()) for name in ["here.json", "there.json"])
    assert here["settings"] == {"plan": there["settings"]["plan"]}
    for document in (here, there):
        del document["stage_us"], document["settings"], document["prostm"]
    del there["controls"], there["warnings"]
    # a plan made here has no emission settings, which limit the power and determine the played plan
    assert len(there.pop("played")) == len(here["paths"])
    power = there.pop("power")
    assert power["share_of_full_scale"] == prostm.even_share(len(here["paths"]), power["limit"])
    assert here == there

    for name in ["here.json", "there.json"]:
        file = prostm.read_plan(tmp_path / name)
        for a, b in zip(file.plan.paths, result.paths, strict=True):
            np.testing.assert_array_equal(a.points, b.points)
            np.testing.assert_array_equal(a.pressure, b.pressure)
            # the file is in mm: not every double in m is exactly a thousandth
            assert abs(a.length - b.length) <= 1e-15 * b.length
        np.testing.assert_array_equal(file.raster.skin, field.skin)
    text = prostm.plan_to_json(result.plan, field, result.settings, result.stats, result.metrics(),
                               prostm.controls(field))
    assert len(json.loads(text)["controls"]) == 3
