"""Bad input raises ValueError (TypeError for a wrong type) with a message about the problem."""

import numpy as np
import prostm
import pytest

from conftest import blobs
from pictures import write_grey_png


def changed(row, col, value):
    pressure = blobs()
    pressure[row, col] = value
    return pressure


@pytest.mark.parametrize("pressure, words", [
    (changed(3, 4, -2.5), "pressure = -2.5 at row 3, column 4 must be at least 0 and finite"),
    (changed(3, 4, np.inf), "pressure = inf at row 3, column 4"),
    (np.zeros(5), "2 dimensions"),
    (np.zeros((2, 3, 4)), "2 dimensions"),
    (3.0, "2 dimensions"),
    (np.zeros((0, 4)), "0 x 4"),
    (np.zeros((4, 0)), "4 x 0"),
    (np.broadcast_to(0.0, (1001, 1000)), r"\(1001, 1000\); it must have at most 1000000"),
    (np.broadcast_to(0.0, (2**30, 2**29)), "1000000"),
])
def test_arrays_that_are_not_fields(pressure, words):
    with pytest.raises(ValueError, match=words):
        prostm.plan(pressure, cell_mm=5)


@pytest.mark.parametrize("pressure", [
    "palm", None, [["a", "b"]], np.zeros((3, 3), complex), np.zeros((3, 3), "M8[s]"), [[1, 2], [3]], {"a": 1},
])
def test_values_that_are_not_numbers(pressure):
    with pytest.raises(TypeError, match="pressure must be an array of numbers"):
        prostm.TargetField(pressure, 5e-3)
    with pytest.raises(TypeError, match="pressure must be an array of numbers"):
        prostm.TargetField(pressure)


@pytest.mark.parametrize("options, words", [
    ({}, "cell in metres or as cell_mm"),
    ({"cell": 5e-3, "cell_mm": 5}, "cell in metres or as cell_mm"),
    ({"cell": 0}, "cell = 0 m must be positive and finite"),
    ({"cell": -1}, "positive"),
    ({"cell": np.nan}, "positive"),
    ({"cell": 5e-3, "origin": (0, np.inf)}, "origin must be finite"),
    ({"cell": 5e-3, "origin": (0, 0, 0)}, "origin has the shape"),
    ({"cell": 5e-3, "height": np.zeros((3, 3))}, "height has the shape"),
    ({"cell": 5e-3, "height": np.full((24, 30), np.inf)}, "height = inf m at row 0"),
    ({"cell": 5e-3, "X_DP": 2 * np.eye(4)}, "last row"),
    ({"cell": 5e-3, "X_DP": np.diag([2, 2, 2, 1])}, "orthonormal"),
    ({"cell": 5e-3, "X_DP": np.eye(3)}, "X_DP has the shape"),
])
def test_invalid_fields(pressure, options, words):
    with pytest.raises(ValueError, match=words):
        prostm.TargetField(pressure, **options)


def test_fields_too_large_for_the_planner(field):
    with pytest.raises(ValueError, match="24 x 30 cells must have at most the planner's max_cells = 100"):
        prostm.Planner(max_cells=100).plan(field)
    with pytest.raises(ValueError, match="cannot be planned"):
        prostm.plan(np.ones((4, 4)), cell=2.0)
    with pytest.raises(ValueError, match="cannot be planned"):
        prostm.plan(np.full((4, 4), 1.1e300), cell=5e-3)
    for cells in (0, -1, 1_000_001):
        with pytest.raises(ValueError, match="max_cells"):
            prostm.Planner(max_cells=cells)
    with pytest.raises(TypeError, match="TargetField"):
        prostm.Planner().plan(field.pressure)


@pytest.mark.parametrize("settings, words", [
    ({"paths": 9}, "paths = 9 must be between 1 and 8"),
    ({"sigma": 0}, "sigma = 0 m must be between"),
    ({"speed": np.nan}, "speed"),
    ({"preset": "papre"}, 'PlanSettings.preset "papre" is unknown'),
    ({"pathz": 4}, "PlanSettings has no setting 'pathz'; did you mean 'paths'"),
    ({"xyzzy": 4}, "known are preset, paths"),
    ({"seed": 2**40}, "32 bits"),
])
def test_settings_out_of_bounds(field, settings, words):
    with pytest.raises(ValueError, match=words):
        prostm.plan(field, **settings)


@pytest.mark.parametrize("name, value", [
    ("paths", 2.5), ("paths", "4"), ("paths", True), ("paths", None), ("sigma", "wide"), ("sigma", True),
    ("sigma", [1.0]), ("preset", 3), ("sigma", np.True_), ("paths", np.float64(3)),
])
def test_settings_of_another_type(name, value):
    settings = prostm.PlanSettings()
    with pytest.raises(TypeError, match=f"PlanSettings.{name} must be"):
        setattr(settings, name, value)
    assert settings == prostm.PlanSettings()


def test_a_cell_size_given_twice(field, tmp_path):
    with pytest.raises(ValueError, match="has its own cell size"):
        prostm.plan(field, cell_mm=5)
    with pytest.raises(ValueError, match="cell_mm"):
        prostm.plan(tmp_path / "x.npy", cell=5e-3)


def test_files_are_rejected_with_the_command_lines_messages(program, tmp_path):
    np.save(tmp_path / "four.npy", np.zeros((2, 2, 2, 2)))
    (tmp_path / "cut.json").write_text('{"format": "prostm-field/1", "cell_mm"')
    (tmp_path / "negative.json").write_text(
        '{"format":"prostm-field/1","cell_mm":5,"origin_mm":[0,0],"rows":1,"cols":2,"pressure":[[1,-2]]}')
    (tmp_path / "field.txt").write_text("1 2 3")
    for name, cell in [("four.npy", 5), ("cut.json", None), ("negative.json", None), ("absent.json", None),
                       ("field.txt", None)]:
        there = program("plan", tmp_path / name, *(["--cell-mm", cell] if cell else []), status=2).stderr
        with pytest.raises(prostm.InputError) as refused:
            prostm.read_field(tmp_path / name, cell_mm=cell)
        assert isinstance(refused.value, ValueError)
        assert str(refused.value) in there


def test_pictures_are_read_as_the_command_line_reads_them(tmp_path):
    grey = np.array([[255, 255, 0], [255, 51, 255]], np.uint8)  # top row first
    write_grey_png(tmp_path / "black.png", grey)
    field = prostm.read_field(tmp_path / "black.png", width_mm=30, invert=True)
    np.testing.assert_allclose(field.pressure, [[0, 0.8, 0], [0, 0, 1]], atol=1e-12)
    assert field.cell == 0.01 and field.shape == (2, 3)
    white = prostm.read_field(tmp_path / "black.png", 10)
    np.testing.assert_allclose(white.pressure, 1 - field.pressure, atol=1e-12)

    np.save(tmp_path / "field.npy", np.ones((2, 4)))
    assert prostm.read_field(tmp_path / "field.npy", width_mm=20).cell == 0.005
    for options, words in [({"width_mm": 20, "cell_mm": 5}, "exclude each other"), ({"width_mm": 0}, "0.01 to 1000 mm"),
                           ({"width_mm": float("nan")}, "width_mm nan over 4 columns"),
                           ({}, "give it in mm with cell_mm, or the width of the field with width_mm"),
                           ({"width_mm": 20, "invert": True}, "is not a picture; leave out invert"),
                           ({"width_mm": 20, "frame": 3}, "holds one field; leave out frame")]:
        with pytest.raises(prostm.InputError, match=words):
            prostm.read_field(tmp_path / "field.npy", **options)
    prostm.write_field(tmp_path / "field.json", field)
    with pytest.raises(prostm.InputError, match="leave out cell_mm and width_mm"):
        prostm.read_field(tmp_path / "field.json", width_mm=20)


def test_images_are_planned_with_the_same_keywords(tmp_path):
    y, x = np.mgrid[0:20, 0:20]
    write_grey_png(tmp_path / "ink.png", np.where(np.hypot(x - 9, y - 11) < 6, 0, 255).astype(np.uint8))
    as_read = {"width_mm": 100, "invert": True}
    wanted = prostm.plan(prostm.read_field(tmp_path / "ink.png", **as_read), "fast")
    for result in (prostm.plan(tmp_path / "ink.png", "fast", **as_read),
                   prostm.Planner(preset="fast").plan(tmp_path / "ink.png", **as_read)):
        assert result.target.cell == 0.005
        np.testing.assert_array_equal(result.target.pressure, wanted.target.pressure)
        np.testing.assert_array_equal(result.paths[0].points, wanted.paths[0].points)
    foci = [prostm.plan(tmp_path / "ink.png", method="am", **as_read),
            prostm.AmPlanner().plan(tmp_path / "ink.png", **as_read)]
    assert foci[0].foci[0].pressure == foci[1].foci[0].pressure > 0

    with pytest.raises(prostm.InputError, match="with cell_mm, or the width of the field with width_mm") as refused:
        prostm.plan(tmp_path / "ink.png")
    assert "--" not in str(refused.value)
    for options in ({"width_mm": 100}, {"invert": True}):
        with pytest.raises(ValueError, match="width_mm and invert belong to the name of a file"):
            prostm.plan(np.ones((3, 3)), cell_mm=5, **options)
    with pytest.raises(ValueError, match="not to an array; make it a TargetField, which takes cell_mm"):
        prostm.Planner().plan(np.ones((3, 3)), cell_mm=5)


@pytest.mark.parametrize("seconds", [-1, 0, 1e-6, 1e9, float("nan"), float("inf")])
def test_the_duration_of_an_emission_is_given_in_seconds(field, seconds):
    with pytest.raises(ValueError, match=r"emit\(\): seconds = \S+ must be between 2.5e-05 and 2500$"):
        prostm.emit(prostm.plan(field, "fast"), seconds=seconds)


def test_invalid_plan_files(tmp_path, field):
    with pytest.raises(ValueError, match="absent.json"):
        prostm.read_plan(tmp_path / "absent.json")
    text = prostm.plan_to_json(prostm.plan(field).plan, field, prostm.PlanSettings())
    with pytest.raises(ValueError, match="mine.*prostm-plan/1"):
        prostm.plan_from_json(text.replace("prostm-plan/1", "prostm-plan/9"), "mine")
    with pytest.raises(ValueError):
        prostm.plan_from_json(text[:200])
    with pytest.raises(ValueError, match="nowhere"):
        prostm.plan(field).write(tmp_path / "nowhere" / "plan.json")


@pytest.mark.parametrize("arguments, words", [
    (([[0, 0, 0]], 1.0), r"\(n, 2\)"),
    (([], 1.0), "points has"),
    ((np.zeros((65, 2)), 1.0), "64"),
    (([[0, np.nan]], 1.0), "coordinate"),
    (([[0, 0], [1e4, 0]], 1.0), "coordinate"),
    (([[0, 0], [0.1, 0]], [1.0]), "pressure has the shape"),
    (([[0, 0], [0.1, 0]], -1.0), "pressure = -1"),
    (([[0, 0], [0.1, 0]], np.inf), "pressure"),
    (([[0, 0], [0.1, 0]], 1.0, 0.0), "speed = 0"),
    (([[0, 0], [0.1, 0]], 1.0, 7.0, 2), "patch = 2"),
])
def test_invalid_paths(arguments, words):
    with pytest.raises(ValueError, match=words):
        prostm.FocalPath(*arguments)


def test_plans_are_checked_where_they_are_used(field):
    path = prostm.FocalPath([[0.05, 0.05], [0.07, 0.05]], 1.0, patch=1)
    with pytest.raises(ValueError, match="at most 8"):
        prostm.Plan([path] * 9)
    with pytest.raises(TypeError):
        prostm.Plan([None])
    with pytest.raises(ValueError, match="patch 1; the target has 1"):
        prostm.lift(prostm.Plan([path]), field)
    plan = prostm.plan(field).plan
    with pytest.raises(ValueError, match="sigma = 0"):
        prostm.quasi_static_field(plan, field, sigma=0)
    with pytest.raises(ValueError, match="gain"):
        prostm.score_plan(field, plan, gain=-1)
    with pytest.raises(ValueError, match="gain_exponent = 3 must be between -2 and 2"):
        prostm.score_plan(field, plan, gain_exponent=3)
    with pytest.raises(ValueError, match="draw_rate = 0 Hz"):
        prostm.controls(field, draw_rate=0)
    with pytest.raises(ValueError, match="rendered has the shape"):
        prostm.score_field(field, np.zeros((3, 3)))
    with pytest.raises(ValueError, match="finite"):
        prostm.score_field(field, np.full(field.shape, np.nan))
    with pytest.raises(ValueError, match="length"):
        prostm.controls(field, length=0)
    with pytest.raises(ValueError, match="at most 2"):
        prostm.TargetFrame([field] * 3)
    with pytest.raises(ValueError, match=r"\(n, 2\)"):
        prostm.height_at(field, [[1.0, 2.0, 3.0]])


@pytest.mark.parametrize("settings, words", [
    ({}, "full_scale_pressure = 0 Pa"),
    ({"full_scale_pressure": 1.0, "foci": 0}, "foci = 0"),
    ({"full_scale_pressure": 1.0, "switch_at": "never"}, "switch_at"),
    ({"full_scale_pressure": 1.0, "sample_rate": 10.0}, "sample_rate"),
    ({"full_scale_pressure": 1.0, "focii": 3}, "did you mean 'foci'"),
])
def test_invalid_emitters(settings, words):
    with pytest.raises(ValueError, match=words):
        prostm.PathEmitter(**settings)


def test_invalid_samples(field):
    emitter = prostm.PathEmitter(full_scale_pressure=1.0)
    for first, samples in [(-1, 40), (0, 0), (0, -4), (0, 10**9)]:
        with pytest.raises(ValueError):
            emitter.fill(first, samples)
    with pytest.raises(ValueError):
        prostm.emit(prostm.plan(field).plan, field, float("nan"), 1.0)
    with pytest.raises(ValueError, match="full_scale"):
        prostm.drive_intensity([1.0], 0.0)
    with pytest.raises(ValueError, match="paths = 0"):
        prostm.even_share(0)
    with pytest.raises(ValueError, match="power_limit = 9"):
        prostm.even_share(2, 9)
