"""Lifetime of the module's objects: views, copies, threads, memory, settings, help."""

import copy
import gc
import inspect
import os
import pickle
import pydoc
import re
import threading
import time

import numpy as np
import prostm
import pytest

from conftest import ROOT, blobs


def test_views_are_read_only_and_keep_their_data(field):
    points = prostm.plan(field).paths[0].points
    height, skin = prostm.TargetField(blobs(), cell_mm=5, height=np.ones((24, 30))).height, field.skin
    before = points.copy(), height.copy()
    gc.collect()
    churn = [prostm.plan(field, paths=k).plan for k in (1, 2, 3)]
    np.testing.assert_array_equal(points, before[0])
    np.testing.assert_array_equal(height, before[1])
    assert len(churn) == 3 and skin.dtype == bool
    for array in (points, height, skin, field.height, field.origin):
        assert not array.flags.writeable and array.base is not None
        with pytest.raises(ValueError):
            array[...] = 0
    path = prostm.plan(field).paths[0]
    assert np.shares_memory(path.points, path.points)


def test_the_source_array_of_a_field_may_change(pressure):
    field = prostm.TargetField(pressure, 5e-3)
    kept = field.pressure
    pressure[:] = 7
    np.testing.assert_array_equal(field.pressure, kept)


@pytest.mark.parametrize("make", [
    lambda p: p.astype(np.float32).astype(np.float64).astype(np.float32),
    lambda p: np.asfortranarray(p.astype(np.float32)),
    lambda p: np.repeat(p.astype(np.float32), 2, axis=1)[:, ::2],
    lambda p: p.astype(np.float32).astype(">f8"),
    lambda p: p.astype(np.float32).tolist(),
    lambda p: np.ma.masked_invalid(p.astype(np.float32)),
    lambda p: np.ma.array(np.nan_to_num(p.astype(np.float32), nan=3.0), mask=np.isnan(p)),
])
def test_any_layout_of_the_same_numbers(pressure, make):
    expected = prostm.TargetField(pressure.astype(np.float32).astype(float), 5e-3)
    field = prostm.TargetField(make(pressure), 5e-3)
    np.testing.assert_array_equal(field.pressure, expected.pressure)
    np.testing.assert_array_equal(field.skin, expected.skin)


def test_pressure_is_nan_where_there_is_no_skin(pressure):
    field = prostm.TargetField(pressure, 5e-3)
    np.testing.assert_array_equal(field.pressure, pressure)
    np.testing.assert_array_equal(np.isnan(field.pressure), ~field.skin)
    np.testing.assert_array_equal(prostm.TargetField(field.pressure, 5e-3).pressure, pressure)
    assert np.isfinite(field.height).all()  # extrapolated off the skin
    with pytest.raises(ValueError):
        field.pressure[0, 5] = 7
    assert prostm.max_pressure(field) == np.nanmax(pressure)
    both = prostm.TargetFrame([field, prostm.TargetField(2 * pressure, 5e-3)])
    assert prostm.max_pressure(both) == 2 * np.nanmax(pressure)
    assert prostm.max_pressure(prostm.TargetFrame([])) == 0


def test_integers_and_booleans_are_valid_pressures():
    for dtype in (bool, np.uint8, np.int16, np.int64):
        ones = np.ones((6, 6), dtype)
        assert prostm.TargetField(ones, 5e-3).pressure.sum() == 36


def test_a_field_without_pressure_gives_a_plan_without_paths():
    for nothing in (np.zeros((5, 5)), np.full((5, 5), np.nan)):
        result = prostm.plan(nothing, cell_mm=5)
        assert result.status == prostm.PlanStatus.EmptyTarget and len(result.plan) == 0 and result.paths == []
        assert not result.quasi_static_field().any() and set(result.metrics().as_dict().values()) == {0.0}
        assert prostm.controls(result.target) == []
        for emission in (prostm.emit(result.plan, result.target, 0.01, 1.0), prostm.emit(result, seconds=0.01)):
            assert emission[1].shape == (400, 1) and not emission[1].any()


def test_settings_follow_the_header():
    """Names and order match PlanSettings::visit, for any number of settings."""
    source = (ROOT / "src" / "prostm" / "plan" / "plan_settings.cpp").read_text()
    fitted, others = source.split("void list(")  # list() ends with list_fit(), which precedes it
    listed = [name for part in (others, fitted) for name in re.findall(r'v\.field\(\{(?:\.name = )?"(\w+)"', part)]
    settings = prostm.PlanSettings()
    assert list(settings.as_dict()) == listed and len(listed) >= 16
    for name, value in settings.as_dict().items():
        assert getattr(settings, name) == value and name in dir(settings) and f"{name}=" in repr(settings)
        assert getattr(prostm.PlanSettings(**{name: value}), name) == value
    assert eval(repr(settings), {"PlanSettings": prostm.PlanSettings}) == settings


def test_settings_are_documented_with_their_bounds():
    text = prostm.PlanSettings.__doc__
    assert "  paths = 4; 1 to 8: largest number of paths" in text
    assert "  speed = 7.0; 0.1 to 8 m/s: " in text
    assert "  preset = 'best'; paper, paper-valid, best, fast or felt: " in text
    assert "  seed = 1; 0 to 2147483647: " in text
    assert not re.search(r"\d\.0 to|to \d+\.0\b", text)


def test_settings_are_values():
    settings = prostm.PlanSettings(paths=2, sigma=5e-3, preset="paper")
    settings.speed = 6
    planner = prostm.Planner(settings, gain=1.2)
    settings.paths = np.int32(3)
    assert planner.settings.paths == 2 and planner.settings.speed == 6.0 and planner.settings.gain == 1.2
    assert settings.gain == 1.4 and settings.paths == 3
    for twin in (copy.copy(settings), copy.deepcopy(settings), settings.copy(), pickle.loads(pickle.dumps(settings))):
        assert twin == settings and twin is not settings
        twin.paths = 1
        assert twin != settings and settings.paths == 3
    assert settings != 4
    with pytest.raises(AttributeError):
        settings.pathz
    with pytest.raises(ValueError, match="did you mean 'paths'"):
        settings.pathz = 4


def test_pickles_are_the_same_to_the_bit(field):
    result = prostm.plan(field)
    again = pickle.loads(pickle.dumps(result.plan))
    for a, b in zip(again.paths, result.paths, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        np.testing.assert_array_equal(a.pressure, b.pressure)
        assert (a.length, a.speed, a.period, a.patch) == (b.length, b.speed, b.period, b.patch)
    in_step = prostm.Plan(result.paths, loop=0.02)
    assert (again.loop, pickle.loads(pickle.dumps(in_step)).loop, prostm.lift(in_step, field).loop) == (0, 0.02, 0.02)
    assert repr(in_step).endswith(", loop=0.02)") and "loop" not in repr(again)
    height = np.linspace(0, 0.01, 720).reshape(24, 30)
    tilted = prostm.TargetField(blobs(), 5e-3, origin=(0.1, 0.2), height=height)
    twin = pickle.loads(pickle.dumps(tilted))
    for name in ["pressure", "skin", "height", "origin", "X_DP", "cell", "shape"]:
        np.testing.assert_array_equal(getattr(twin, name), getattr(tilted, name))
    assert tilted.weight is None and twin.weight is None
    weighted = prostm.TargetField(blobs(), 5e-3, weight=height + 1)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(weighted)).weight, weighted.weight)


def test_weights_apply_to_errors():
    pressure = np.zeros((24, 40))
    pressure[10:14, 6:10] = pressure[10:14, 30:34] = 1.0
    pressure[0, 0] = np.nan
    weight = np.ones((24, 40))
    weight[:, 20:] = 4
    weight[0, 0] = np.nan  # no skin, so it is ignored
    field = prostm.TargetField(pressure, cell_mm=4, weight=weight)
    assert field.weight[0, 0] == 0 and field.weight[5, 5] == 1 and field.weight[5, 25] == 4
    assert not field.weight.flags.writeable and field.weight.base is not None
    assert prostm.plan(field, paths=1).paths[0].points[:, 0].mean() > 0.1
    assert prostm.plan(prostm.TargetField(pressure, cell_mm=4, weight=5 - weight),
                       paths=1).paths[0].points[:, 0].mean() < 0.06
    np.testing.assert_array_equal(prostm.field_from_json(prostm.field_to_json(field)).weight, field.weight)


def test_a_reset_planner_repeats_its_plan(field):
    planner = prostm.Planner()
    first = planner.plan(field)
    planner.reset()
    second, other = planner.plan(field), prostm.plan(field)
    for a, b, c in zip(first.paths, second.paths, other.paths, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        np.testing.assert_array_equal(a.points, c.points)


def test_threads_may_share_planner_and_field(field):
    """The interpreter's lock is released, and each plan is complete."""
    planner = prostm.Planner(preset="paper-valid", clusters=20, refine_iterations=20)
    expected = planner.plan(field).paths[0].points.copy()
    wrong, done = [], []

    def work():
        for _ in range(50):
            if not np.array_equal(planner.plan(field).paths[0].points, expected):
                wrong.append(threading.get_ident())
        done.append(True)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(done) == 4 and not wrong


def longest_pause_beside(work):
    """Returns the longest pause of this thread while another runs work(), as a fraction of the duration of work()."""
    times = []

    def timed():
        times.append(time.perf_counter())
        work()
        times.append(time.perf_counter())

    thread = threading.Thread(target=timed)
    longest, last = 0.0, time.perf_counter()
    thread.start()
    while len(times) < 2:
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    longest = max(longest, time.perf_counter() - last)
    thread.join()
    return longest / (times[1] - times[0])


def test_python_keeps_running_while_a_plan_is_made_and_scored():
    """A call that held the lock would be one pause as long as the call."""
    planner = prostm.Planner(max_cells=160_000, preset="paper")
    field = prostm.TargetField(np.random.default_rng(1).random((400, 400)), 1e-4)
    plan = planner.plan(field).plan
    assert longest_pause_beside(lambda: planner.plan(field)) < 0.6
    assert longest_pause_beside(lambda: prostm.score_plan(field, plan)) < 0.6
    assert longest_pause_beside(lambda: pow(7, 3_000_000)) > 0.6  # holds the lock


def resident_pages():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1])


def test_ten_thousand_plans_leak_no_memory(pressure):
    planner = prostm.Planner(preset="fast")

    def once():
        field = prostm.TargetField(pressure, 5e-3)
        result = planner.plan(field)
        for path in result.paths:
            path.points, path.pressure, path.length
        return result

    for _ in range(1000):
        once()
    before = resident_pages()
    for _ in range(10_000):
        once()
    # a plan is 13 kB, a field 12 kB: leaking one in a hundred would take 2.5 MB
    assert (resident_pages() - before) * os.sysconf("SC_PAGE_SIZE") < 1 << 20


def test_other_calls_leak_no_memory(field, tmp_path):
    plan = prostm.plan(field).plan
    emitter = prostm.PathEmitter(full_scale_pressure=1.0)
    sample = 0

    def once():
        nonlocal sample
        prostm.quasi_static_field(plan, field)
        prostm.score_plan(field, plan)
        prostm.plan_from_json(prostm.plan_to_json(plan, field, prostm.PlanSettings(paths=2)))
        emitter.submit(prostm.lift(plan, field))
        emitter.fill(sample, 40)
        sample += 40
        for bad in (lambda: prostm.PlanSettings(nothing=1), lambda: prostm.TargetField([[-1.0]], 1.0)):
            with pytest.raises(ValueError):
                bad()

    for _ in range(100):
        once()
    before = resident_pages()
    for _ in range(1000):
        once()
    assert (resident_pages() - before) * os.sysconf("SC_PAGE_SIZE") < 1 << 20


def public_names():
    return [(name, getattr(prostm, name)) for name in prostm.__all__]


def test_every_public_name_is_documented():
    for name, value in public_names():
        if isinstance(value, int):
            continue
        assert value.__doc__ and value.__module__ == "prostm", name
        for member, attribute in vars(value).items() if inspect.isclass(value) else []:
            if not member.startswith("_") and member not in ("name", "value"):  # an enumeration's own members
                assert (attribute.__doc__ or "").strip(), f"{name}.{member}"
    text = pydoc.plain(pydoc.render_doc(prostm))
    assert "_prostm." not in text and "Planner" in text and "(rows, cols)" in text


def test_the_type_stubs_match_the_module():
    stub = (ROOT / "python" / "prostm" / "__init__.pyi").read_text()
    declared = set(re.findall(r"^(?:def|class) (\w+)", stub, flags=re.M)) - {"_Settings"}
    declared |= set(re.findall(r"^(k\w+):", stub, flags=re.M))
    assert declared == set(prostm.__all__)
    for name, value in public_names():
        block = re.search(rf"^class {name}\b.*?(?=^\S|\Z)", stub, flags=re.M | re.S)
        if not inspect.isclass(value) or block is None:
            continue
        for member in vars(value):
            if not member.startswith("_") and name not in ("PlanStatus",):
                declared_in = block.group() + stub.split("class PlanSettings")[0]
                assert re.search(rf"\b{member}\b", declared_in), f"{name}.{member}"
        for member in re.findall(r"^    (\w+):", block.group(), flags=re.M):
            assert hasattr(value, member) or member in dir(value()), f"{name}.{member} is declared and not there"


def test_a_reset_planner_plans_like_a_new_one():
    pressure = np.zeros((20, 20))
    pressure[5:12, 6:15] = 1.0
    target = prostm.TargetField(pressure, cell_mm=4)
    planner = prostm.Planner(preset="best")
    first = planner.plan(target).plan
    planner.plan(target)
    planner.reset()
    again = planner.plan(target).plan
    assert len(first.paths) == len(again.paths) > 0
    for a, b in zip(first.paths, again.paths):
        assert (a.points == b.points).all() and (a.pressure == b.pressure).all()
