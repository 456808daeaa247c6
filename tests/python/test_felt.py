"""The planner's model of the felt field, in double precision, and plans in step that use it."""

import pickle

import numpy as np
import prostm
import pytest

from conftest import ROOT, blobs

SIGMA = 4.3e-3  # focus of an array


@pytest.fixture(scope="module")
def field():
    return prostm.read_field(ROOT / "data" / "four-plumes.json")


@pytest.fixture(scope="module")
def plan(field):
    return prostm.plan(field, preset="felt", sigma=SIGMA).plan


def with_path(plan, k, points=None, pressure=None):
    """Returns the plan with path k replaced."""
    paths = plan.paths
    points = paths[k].points if points is None else points
    paths[k] = prostm.FocalPath(points, paths[k].pressure if pressure is None else pressure, paths[k].speed)
    return prostm.Plan(paths, loop=plan.loop)


def test_arrays_have_the_documented_shapes(field, plan):
    felt = prostm.felt_plan(plan, field, SIGMA)
    blocks, skins = len(felt.area), prostm.felt_skins()
    assert felt.positions.shape == (blocks, 2) and felt.pressure.shape == (blocks,)
    assert felt.percept.shape == (len(skins), blocks) and len(skins) == 3 and blocks > 50
    assert [g.shape for g in felt.by_pressure] == [path.pressure.shape for path in plan.paths]
    assert [g.shape for g in felt.by_point] == [path.points.shape for path in plan.paths]
    arrays = [felt.positions, felt.area, felt.pressure, felt.percept, *felt.by_pressure, *felt.by_point]
    assert all(a.dtype == np.float64 and not a.flags.writeable and np.isfinite(a).all() for a in arrays)
    assert repr(felt) == f"FeltPlan(lack={felt.lack!r}, {blocks} blocks, 3 skins)"
    areas = felt.area.copy()
    del felt, arrays[0]
    np.testing.assert_array_equal(arrays[0], areas)


def test_the_blocks_match_the_target(field, plan):
    felt = prostm.felt_plan(plan, field, SIGMA)
    assert felt.area.sum() == pytest.approx(1.0, rel=1e-12) and (felt.area > 0).all()
    p = field.pressure[field.skin]
    # the mean over the skin, and its centre
    assert felt.area @ felt.pressure == pytest.approx(p.mean() / p.max(), rel=1e-6)
    rows, cols = np.nonzero(field.skin)
    middle = field.origin + field.cell * np.array([cols.mean(), rows.mean()])
    np.testing.assert_allclose(felt.area @ felt.positions, middle, rtol=1e-9)


def test_the_lack_matches_the_percept(field, plan):
    """Part of (W3) from the arrays themselves: 1 - skill_0 of each skin, which is below the lack by 1 - skill_8."""
    felt = prostm.felt_plan(plan, field, SIGMA)
    a, p = felt.area, felt.pressure
    lack_0 = []
    for r in felt.percept:
        gain = (a @ (p * r)) / (a @ (r * r))
        lack_0.append((a @ (p - gain * r) ** 2) / (a @ (p - a @ p) ** 2))
    assert 0.3 * np.mean(lack_0) < felt.lack < np.mean(lack_0) * 1.3
    # a percept scales with its pressures, and the lack does not depend on the scale
    doubled = prostm.Plan([prostm.FocalPath(path.points, 2 * path.pressure, path.speed) for path in plan.paths],
                          loop=plan.loop)
    twice = prostm.felt_plan(doubled, field, SIGMA)
    assert twice.lack == pytest.approx(felt.lack, rel=1e-9)
    np.testing.assert_allclose(twice.percept, 2 * felt.percept, rtol=1e-9)


def test_the_gradient_matches_the_lack(field, plan):
    felt = prostm.felt_plan(plan, field, SIGMA)
    largest = prostm.max_pressure(field)

    def lack(**changed):
        return prostm.felt_plan(with_path(plan, k, **changed), field, SIGMA).lack

    for k, i in [(0, 0), (1, 13), (len(plan.paths) - 1, 19)]:
        path = plan.paths[k]
        one = np.zeros(len(path.pressure))
        one[i] = 1e-5 * largest
        slope = (lack(pressure=path.pressure + one) - lack(pressure=path.pressure - one)) / 2e-5
        assert felt.by_pressure[k][i] * largest == pytest.approx(slope, abs=1e-6)
        for axis in (0, 1):
            moved = np.zeros(path.points.shape)
            moved[i, axis] = 1e-7
            slope = (lack(points=path.points + moved) - lack(points=path.points - moved)) / 2e-4
            assert 1e-3 * felt.by_point[k][i, axis] == pytest.approx(slope, abs=1e-6)


def test_the_preset_lacks_less_than_best(field):
    def lack(**settings):
        own = prostm.plan(field, sigma=SIGMA, **settings).plan
        return prostm.felt_plan(prostm.Plan(own.paths, loop=own.loop or 0.02), field, SIGMA).lack

    assert lack(preset="felt") < 0.7 * lack()


def test_settings_of_earlier_versions_select_the_preset_with_a_warning(field, plan):
    for old in ({"felt_weight": 0.9}, {"felt_points": True, "preset": "fast"}):
        words = f'PlanSettings.{next(iter(old))} was replaced by preset "felt", which is used'
        with pytest.warns(FutureWarning, match=words) as warnings:
            own = prostm.plan(field, sigma=SIGMA, **old).plan
        assert len(warnings) == 1
        assert own.loop == plan.loop and len(own.paths) == len(plan.paths)
    assert prostm.PlanSettings(felt_weight=0, felt_points=False).preset == "best"
    assert "felt_weight" not in repr(prostm.PlanSettings())


def test_felt_plans_are_in_step(field, plan):
    assert 0.01 <= plan.loop <= 0.02  # at most 1 / draw_rate
    for path in plan.paths:
        laps = plan.loop / path.period
        assert laps == pytest.approx(round(laps), abs=1e-9) and path.speed <= 7 * (1 + 1e-9)
    assert prostm.plan(field).plan.loop == 0
    foci = prostm.plan(field, method="am", felt_weight=0.9).foci
    assert any(focus.phase > 0 for focus in foci)
    assert all(focus.phase == 0 for focus in prostm.plan(field, method="am").foci)


def test_skins_are_values(field, plan):
    usual, slow, fast = prostm.felt_skins()
    assert usual == prostm.SkinSettings() and slow != usual and usual != 3
    assert (slow.slow_speed, slow.fast_speed) == pytest.approx((0.7 * 3, 0.7 * 7), rel=1e-12)
    assert fast.fast_speed == pytest.approx(1.3 * 7, rel=1e-12) and fast.loss == usual.loss == 0.14
    stiff = prostm.SkinSettings(fast_speed=10.0, loss=0.07)
    assert repr(stiff) == "SkinSettings(slow_speed=3, fast_speed=10, loss=0.07, density=1100)"
    assert pickle.loads(pickle.dumps(stiff)) == stiff and len({stiff, usual, prostm.SkinSettings()}) == 2
    with pytest.raises(AttributeError):
        stiff.loss = 0.1
    # the lack is the mean over the skins
    each = [prostm.felt_plan(plan, field, SIGMA, [skin]).lack for skin in (slow, usual, fast)]
    assert prostm.felt_plan(plan, field, SIGMA).lack == pytest.approx(np.mean(each), rel=1e-9)
    assert prostm.felt_plan(plan, field, SIGMA, skins=(stiff,)).percept.shape[0] == 1
    for wrong, words in [({"loss": 2}, "loss = 2 must be between 0 and 1"), ({"slow_speed": 0}, "slow_speed = 0 m/s"),
                         ({"fast_speed": 1}, "fast_speed = 1 m/s must be between 3"), ({"density": np.nan}, "density")]:
        with pytest.raises(ValueError, match=words):
            prostm.SkinSettings(**wrong)


def test_errors_are_sentences(field, plan):
    for words, wrong in [
        ("not in step.*preset felt", prostm.Plan(plan.paths)),
        ("no path", prostm.Plan()),
        ("no path", prostm.Plan(foci=[prostm.FocalPoint([0, 0], 1.0)])),
        ("fewer than 3 points", prostm.Plan([prostm.FocalPath([[0, 0], [0.01, 0]], 1.0)], loop=0.02)),
        ("no length", prostm.Plan([prostm.FocalPath([[0, 0]] * 3, 1.0)], loop=0.02)),
        ("no pressure anywhere", prostm.Plan([prostm.FocalPath(plan.paths[0].points, 0.0)], loop=0.02)),
    ]:
        with pytest.raises(ValueError, match=words):
            prostm.felt_plan(wrong, field, SIGMA)
    for words, arguments in [
        ("target has no pressure", (plan, prostm.TargetField(0 * blobs(), 5e-3), SIGMA)),
        ("at least one skin", (plan, field, SIGMA, [])),
        ("sigma = 8.6 m must be between 0.001 and 0.05 m", (plan, field, 8.6)),
        ("sigma = nan m", (plan, field, np.nan)),
    ]:
        with pytest.raises(ValueError, match=words):
            prostm.felt_plan(*arguments)
    for words, settings in [
        ("felt_weight selects preset felt, but the preset is paper: remove one of them", {"preset": "paper"}),
        ("felt_weight = 1.1 must be between 0 and 1", {"felt_weight": 1.1}),
        ("felt_weight = -1 must be between 0 and 1", {"felt_weight": -1, "method": "am"}),
    ]:
        with pytest.raises(ValueError, match=words):
            prostm.plan(field, **{"felt_weight": 0.9} | settings)
    result = prostm.plan(field, "fast")
    for words, arguments in [
        ("felt_plan(): plan must be a Plan, not a PlanResult; give its .plan", (result, field, SIGMA)),
        ("felt_plan(): target must be a TargetField, not a TargetFrame", (plan, prostm.TargetFrame([field]), SIGMA)),
        ("felt_plan(): skins must be a list of SkinSettings or None, not a SkinSettings",
         (plan, field, SIGMA, prostm.SkinSettings())),
        ("felt_plan(): skins[1] must be a SkinSettings, not None", (plan, field, SIGMA, [prostm.SkinSettings(), None])),
    ]:
        with pytest.raises(TypeError) as refused:
            prostm.felt_plan(*arguments)
        assert str(refused.value) == words
