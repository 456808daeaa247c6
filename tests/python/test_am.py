"""The AM baseline in Python: the command line's foci, their model, and their modulation."""

import json
import pickle

import numpy as np
import prostm
import pytest


def test_the_foci_match_the_command_line(program, tmp_path, pressure):
    np.save(tmp_path / "field.npy", pressure)
    program("plan", tmp_path / "field.npy", "--cell-mm", 5, "--method", "am", "--json", tmp_path / "there.json")
    result = prostm.plan(pressure, cell_mm=5, method="am")
    result.write(tmp_path / "here.json")
    here, there = (json.loads((tmp_path / name).read_text()) for name in ("here.json", "there.json"))
    assert here["foci"] == there["foci"] and len(here["foci"]) == 4
    assert here["method"] == there["method"] == "am" and here["metrics"] == there["metrics"]
    assert here["settings"] == {"am": there["settings"]["am"]}
    read = prostm.read_plan(tmp_path / "there.json").plan
    assert [focus.pressure for focus in read.foci] == [focus.pressure for focus in result.foci]
    assert not read.paths and len(read) == 4


def test_the_model_uses_the_nearest_focus(field):
    result = prostm.AmPlanner(foci=3, sigma=0.012).plan(field)
    assert result.settings == prostm.AmSettings(foci=3, sigma=0.012) and result.status == prostm.PlanStatus.Planned
    rows, cols = field.pressure.shape
    y, x = np.mgrid[0:rows, 0:cols] * 0.005
    at = np.array([focus.position for focus in result.foci])
    square = (x[..., None] - at[:, 0]) ** 2 + (y[..., None] - at[:, 1]) ** 2
    p = np.array([focus.pressure for focus in result.foci])[square.argmin(-1)]
    expected = p * np.exp(-square.min(-1) / (2 * 0.012**2))
    np.testing.assert_allclose(prostm.quasi_static_field(result.plan, field, sigma=0.012), expected, rtol=1e-9)
    # the peaks are played, as 32-bit samples
    np.testing.assert_allclose(result.quasi_static_field(), expected, rtol=1e-6)
    assert result.metrics().rmse == pytest.approx(prostm.score_plan(field, result.plan, sigma=0.012).rmse, rel=1e-5)
    names = [control.name for control in prostm.controls(field, other=result.plan)]
    assert "random foci, solved pressures" in names


def test_foci_are_modulated_in_place(field):
    result = prostm.plan(field, method="am", foci=2)
    lifted = prostm.lift(result.plan, field)
    assert len(lifted.foci) == 2 and not lifted.paths
    positions, intensities = prostm.emit(result.plan, field, 0.02, 2 * prostm.max_pressure(field))
    assert positions.shape == (800, 2, 3) and (positions == positions[0]).all()
    np.testing.assert_allclose(intensities[200:400], intensities[400:600], atol=1e-7)
    assert (intensities[::200] == 0).all()
    for k, focus in enumerate(lifted.foci):
        mine = np.linalg.norm(positions[0] - focus.p_D, axis=1).argmin()
        peak = prostm.drive_intensity(focus.pressure, 2 * prostm.max_pressure(field))
        assert intensities[100, mine] == pytest.approx(float(peak), abs=1e-6), k
    cosine = prostm.emit(result.plan, field, 0.005, 1e3, am_waveform="raised-cosine", silent_below=0.0)[1]
    np.testing.assert_allclose(cosine[:, 0] / cosine[100, 0], np.sin(np.pi * np.arange(200) / 200) ** 2, atol=1e-6)


def test_plans_of_foci_are_values():
    plan = prostm.Plan(foci=[prostm.FocalPoint([0.01, 0.02], 3.0, patch=1)])
    again = pickle.loads(pickle.dumps(plan))
    assert again.foci[0].position.tolist() == [0.01, 0.02]
    assert (again.foci[0].pressure, again.foci[0].patch, len(again)) == (3.0, 1, 1)
    assert "FocalPoint([0.01, 0.02], pressure=3.0)" in repr(plan)
    with pytest.raises(ValueError):
        plan.foci[0].position[0] = 0
    plan = prostm.Plan(foci=[prostm.FocalPoint([0.01, 0.02], 3.0, phase=0.25)])
    assert pickle.loads(pickle.dumps(plan)).foci[0].phase == 0.25
    assert "FocalPoint([0.01, 0.02], pressure=3.0, phase=0.25)" in repr(plan)


def test_phases_are_played(field):
    foci = [prostm.FocalPoint([0.01 * k, 0.0], 1.0, phase=0.3 * k) for k in range(3)]
    lifted = prostm.lift(prostm.Plan(foci=foci), field)
    assert [focus.phase for focus in lifted.foci] == [0, 0.3, 0.6]
    emitter = prostm.FocusEmitter(foci=3, full_scale_pressure=1.0)
    emitter.submit(lifted)
    positions, intensities = emitter.fill(0, 600)
    k = np.arange(200)
    for f in range(3):
        mine = np.linalg.norm(positions[-1] - lifted.foci[f].p_D, axis=1).argmin()
        np.testing.assert_allclose(intensities[400:, mine], np.abs(np.sin(np.pi * (k / 200 - 0.3 * f))), atol=1e-6)


def test_invalid_plans_and_settings(field):
    focus = prostm.FocalPoint([0, 0], 1.0)
    path = prostm.FocalPath([[0, 0], [0.01, 0]], 1.0)
    for words, call in [
        ("paths or foci, not both", lambda: prostm.Plan([path], [focus])),
        ("9 foci", lambda: prostm.Plan(foci=9 * [focus])),
        ("a plan of foci has no loop", lambda: prostm.Plan(foci=[focus], loop=0.02)),
        ("loop = 2 s must be 0 or between 0.001 and 1 s", lambda: prostm.Plan([path], loop=2)),
        ("loop = nan s must be", lambda: prostm.Plan([path], loop=np.nan)),
        ("phase = 1.5 must be between 0 and 1", lambda: prostm.FocalPoint([0, 0], 1.0, phase=1.5)),
        ("pressure", lambda: prostm.FocalPoint([0, 0], -1.0)),
        ("position", lambda: prostm.FocalPoint([0, np.nan], 1.0)),
        ("foci = 9", lambda: prostm.AmPlanner(foci=9)),
        ("fm", lambda: prostm.plan(field, method="fm")),
        ("preset", lambda: prostm.plan(field, "best", method="am")),
        ("am_frequency", lambda: prostm.FocusEmitter(full_scale_pressure=1.0, am_frequency=400)),
        ("am_waveform", lambda: prostm.FocusEmitter(full_scale_pressure=1.0, am_waveform="square")),
        ("patch 1", lambda: prostm.lift(prostm.Plan(foci=[prostm.FocalPoint([0, 0], 1.0, patch=1)]), field)),
        ("AmSettings", lambda: prostm.plan_to_json(prostm.Plan(foci=[focus]), field, prostm.PlanSettings())),
    ]:
        with pytest.raises(ValueError, match=words):
            call()
    # the other method's emitter rejects such a plan
    emitter = prostm.PathEmitter(full_scale_pressure=1.0)
    emitter.submit(prostm.lift(prostm.Plan(foci=[focus]), field))
    assert emitter.fill(0, 40)[1].max() == 0 and emitter.stats().refused_plans == 1
