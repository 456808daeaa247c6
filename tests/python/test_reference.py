"""The module's results, compared with the same equations in numpy."""

from types import SimpleNamespace

import numpy as np
import prostm
import pytest

SIGMA, GAIN = 8.6e-3, 1.4


def eq1(paths, field, sigma=SIGMA, gain=GAIN):
    """Computes the paper's Eq. (1) on the raster, by brute force over all segments: (rows, cols)."""
    cols, rows = np.meshgrid(np.arange(field.cols), np.arange(field.rows))
    x = field.origin + field.cell * np.stack([cols, rows], axis=-1)
    nearest, pressure = np.full(field.shape, np.inf), np.zeros(field.shape)
    for path in paths:
        a, b = path.points, np.roll(path.points, -1, axis=0)
        p, q = path.pressure, np.roll(path.pressure, -1)
        for i in range(len(a)):
            edge = b[i] - a[i]
            length2 = edge @ edge
            t = np.clip((x - a[i]) @ edge / length2, 0, 1) if length2 > 0 else np.zeros(field.shape)
            d2 = ((x - a[i] - t[..., None] * edge) ** 2).sum(axis=-1)
            closer = d2 < nearest
            nearest = np.where(closer, d2, nearest)
            pressure = np.where(closer, p[i] + t * (q[i] - p[i]), pressure)
    return pressure / gain * np.exp(-nearest / (2 * sigma**2))


@pytest.mark.parametrize("preset", ["paper", "paper-valid"])
@pytest.mark.parametrize("sigma, gain", [(SIGMA, GAIN), (4e-3, 1.0)])
def test_quasi_static_field_is_eq_1(field, preset, sigma, gain):
    plan = prostm.plan(field, preset).plan
    ours = prostm.quasi_static_field(plan, field, sigma=sigma, gain=gain)
    assert ours.shape == field.shape and ours.dtype == np.float64
    np.testing.assert_allclose(ours, eq1(plan.paths, field, sigma, gain), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("preset", ["paper", "best"])
def test_every_path_has_the_gain_of_its_period(field, preset):
    ample = 1e5 * prostm.max_pressure(field)  # a full output that limits no pressure
    settings = prostm.PlanSettings(preset=preset, gain_exponent=-0.7, draw_rate=60, full_scale_pressure=ample)
    result = prostm.plan(field, settings=settings)
    constant = prostm.plan(field, preset, draw_rate=60, full_scale_pressure=ample)
    gains = [GAIN * (path.period * 60) ** -0.7 for path in result.paths]
    for path, other, gain in zip(result.paths, constant.paths, gains):
        np.testing.assert_allclose(path.pressure, other.pressure * gain / GAIN, rtol=1e-12)
    # Eq. (1) with effective pressures, and the model by which a result scores itself
    effective = [prostm.FocalPath(path.points, path.pressure / gain) for path, gain in zip(result.paths, gains)]
    rendered = prostm.quasi_static_field(result.plan, field, gain_exponent=-0.7, draw_rate=60)
    np.testing.assert_allclose(rendered, eq1(effective, field, gain=1.0), rtol=1e-9, atol=1e-12)
    metrics = prostm.score_plan(field, result.plan, gain_exponent=-0.7, draw_rate=60)
    without = prostm.score_plan(field, constant.plan, draw_rate=60)
    assert metrics.rmse == pytest.approx(without.rmse, rel=1e-9)
    with_law = prostm.controls(field, other=result.plan, gain_exponent=-0.7, draw_rate=60)
    for one, two in zip(with_law, prostm.controls(field, other=constant.plan, draw_rate=60)):
        assert one.metrics.rmse == pytest.approx(two.metrics.rmse, rel=1e-9)


def test_the_gain_of_a_path_derived_from_the_skin(field):
    ample = 1e5 * prostm.max_pressure(field)
    result = prostm.plan(field, gain_from_skin=True, full_scale_pressure=ample)
    constant = prostm.plan(field, full_scale_pressure=ample)
    periods = np.arange(5, 20.1, 2.5) * 1e-3  # (P9c)
    gains = [np.interp(path.period, periods, [0.713, 0.744, 0.825, 0.869, 0.930, 0.975, 1]) for path in result.paths]
    for path, other, gain in zip(result.paths, constant.paths, gains):
        np.testing.assert_allclose(path.pressure, other.pressure * gain, rtol=1e-9)
    one = prostm.score_plan(field, result.plan, gain_from_skin=True)
    assert one.rmse == pytest.approx(prostm.score_plan(field, constant.plan).rmse, rel=1e-9)
    for one, two in zip(prostm.controls(field, other=result.plan, gain_from_skin=True),
                        prostm.controls(field, other=constant.plan)):
        assert one.metrics.rmse == pytest.approx(two.metrics.rmse, rel=1e-9)
    np.testing.assert_allclose(prostm.quasi_static_field(result.plan, field, gain_from_skin=True),
                               prostm.quasi_static_field(constant.plan, field), rtol=1e-9, atol=1e-12)


def test_metrics_match_eq_1(field):
    result = prostm.plan(field, "paper")
    p, r = field.pressure[field.skin], eq1(result.paths, field)[field.skin]
    p, r = p / p.max(), r / p.max()
    g = p @ r / (r @ r)
    metrics = prostm.score_plan(field, result.plan)
    assert metrics.rmse == pytest.approx(np.sqrt(np.mean((p - r) ** 2)), rel=1e-9)
    assert metrics.correlation == pytest.approx(np.corrcoef(p, r)[0, 1], rel=1e-9)
    assert metrics.skill_0 == pytest.approx(1 - ((p - g * r) ** 2).sum() / ((p - p.mean()) ** 2).sum(), rel=1e-9)
    assert metrics.overlap == pytest.approx(np.minimum(p, g * r).sum() / np.maximum(p, g * r).sum(), rel=1e-9)
    assert metrics.spill == pytest.approx(r[p < 0.1].sum() / r.sum(), rel=1e-9)
    assert 0 < metrics.coverage <= 1
    rendered = prostm.quasi_static_field(result.plan, field)
    assert prostm.score_field(field, rendered, metrics.coverage).as_dict() == metrics.as_dict()


def second_lap(field, plan, full_scale):
    """Returns the emitter's second lap on each path, as paths of many points."""
    positions, intensities = prostm.emit(plan, field, 0.1, full_scale)
    paths = []
    for path in plan.paths:
        # a focal point rests at the path's first point before the first lap
        k = np.linalg.norm(positions[0, :, :2] - path.points[0], axis=1).argmin()
        n = int(np.ceil(path.length / path.speed * 40e3 - 1e-6))
        lap = slice(1 + n, 1 + 2 * n)
        xy = positions[lap, k, :2].astype(float)
        paths.append(SimpleNamespace(points=xy, pressure=full_scale * intensities[lap, k].astype(float) ** 2))
    return paths


@pytest.mark.parametrize("preset", ["paper-valid", "best"])
def test_the_quality_of_a_result_is_that_of_the_played_plan(preset):
    # contacts so thin that the pressures along a path change faster than an intensity may
    x = 2e-3 * np.arange(50)
    thin = [np.exp(-((x - a) ** 2)[None] / 2e-5 - ((x - b) ** 2)[:, None] / 2e-5)
            for a, b in [(0.03, 0.03), (0.06, 0.05)]]
    field = prostm.TargetField(sum(thin), cell=2e-3)
    result = prostm.plan(field, preset)
    for factor in (GAIN, 2.0, 0.7):
        full_scale = factor * prostm.max_pressure(field)
        settings = prostm.EmitSettings(full_scale_pressure=full_scale)
        played = eq1(second_lap(field, result.plan, full_scale), field)
        ours = result.quasi_static_field(emission=settings)
        metrics = result.metrics(emission=settings)
        assert prostm.score_field(field, ours, metrics.coverage).as_dict() == metrics.as_dict()
        # cells equally close to two paths may belong to either
        assert np.quantile(np.abs(ours - played), 0.99) < 0.02 * prostm.max_pressure(field)
        assert prostm.score_field(field, played).rmse == pytest.approx(metrics.rmse, rel=0.05)
    # the default full scale is the gain times the largest pressure
    settings = prostm.EmitSettings(full_scale_pressure=GAIN * prostm.max_pressure(field))
    assert result.metrics().as_dict() == result.metrics(emission=settings).as_dict()


def test_the_felt_field_of_a_plan_needs_an_array(field):
    result = prostm.plan(field, "best")
    assert np.isnan(result.metrics().felt_skill) and "felt_skill" not in result.metrics().as_dict()
    felt = result.metrics(array="usx")
    assert 0.3 < felt.felt_skill <= 1 and felt.as_dict()["felt_skill"] == felt.felt_skill
    assert {**felt.as_dict(), **result.metrics().as_dict()} == felt.as_dict()
    assert result.metrics(array="usx").felt_skill == felt.felt_skill != result.metrics(array="autd3").felt_skill
    with pytest.raises(ValueError, match="no-such"):
        result.metrics(array="no-such")


def test_the_strength_of_a_plan_is_a_level_above_the_threshold_of_touch(field):
    result = prostm.plan(field, "best")
    assert np.isnan(result.metrics().sensation_level)
    level = result.metrics(array="usx").sensation_level
    assert -30 < level < 30
    below, above = prostm.sensation_interval("usx")
    assert below == above == pytest.approx(np.hypot(3, np.hypot(1.96 * 4, 4)))
    words = prostm.sensation_words(level, "usx")
    assert words.startswith(f"about {abs(level):.0f} dB ") and f"({level - below:.0f} to {level + above:.0f} dB)" in words
    with pytest.raises(ValueError, match="level"):
        prostm.sensation_words(float("nan"))


def test_a_plan_beats_its_controls(field):
    mine = prostm.plan(field, "paper").metrics()
    table = prostm.controls(field)
    assert [c.name for c in table][0] == "flat field" and len(table) == 3
    assert all(mine.skill_0 > c.metrics.skill_0 for c in table)


def test_a_custom_path(field):
    angle = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    points = [0.07, 0.06] + 0.02 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    path = prostm.FocalPath(points, 1.4)
    sides = np.linalg.norm(points - np.roll(points, -1, axis=0), axis=1)
    assert path.length == pytest.approx(sides.sum(), rel=1e-14) == prostm.closed_length(path)
    assert path.period == path.length / path.speed and path.speed == 7.0
    np.testing.assert_array_equal(path.points, points)
    np.testing.assert_array_equal(path.pressure, np.full(32, 1.4))
    plan = prostm.Plan([path, prostm.FocalPath([[0.1, 0.02], [0.12, 0.02]], [1.0, 2.0], speed=5, patch=0)])
    np.testing.assert_allclose(prostm.quasi_static_field(plan, field), eq1(plan.paths, field), rtol=1e-9, atol=1e-12)


def test_heights_and_planes():
    y, x = np.mgrid[0:10, 0:12] * 5e-3
    pressure = np.where((x - 0.03) ** 2 + (y - 0.02) ** 2 < 0.02**2, 1.0, np.nan)
    height = 0.1 * x + 0.05 * y
    X_DP = np.array([[0, -1, 0, 0.01], [1, 0, 0, 0.02], [0, 0, 1, 0.25], [0, 0, 0, 1.0]])
    field = prostm.TargetField(pressure, 5e-3, origin=(0.01, -0.02), height=height, X_DP=X_DP)
    np.testing.assert_array_equal(field.X_DP, X_DP)
    np.testing.assert_array_equal(field.height[field.skin], height[field.skin])
    assert np.isfinite(field.height).all()
    np.testing.assert_array_equal(field.skin, ~np.isnan(pressure))
    # bilinear heights are exact on a slope
    at = field.origin + [[0.03, 0.02], [0.031, 0.0225]]
    np.testing.assert_allclose(prostm.height_at(field, at), [0.1 * 0.03 + 0.05 * 0.02, 0.1 * 0.031 + 0.05 * 0.0225])

    # lifted: every point lies on the plane's pose of (x, y, height)
    path = prostm.FocalPath(field.origin + [[0.025, 0.015], [0.035, 0.015], [0.03, 0.025]], 1.0)
    lifted = prostm.lift(prostm.Plan([path]), field).paths[0]
    assert len(lifted.p_D) == 15
    in_plane = (lifted.p_D - X_DP[:3, 3]) @ X_DP[:3, :3]
    np.testing.assert_allclose(in_plane[::5, :2], path.points, atol=1e-15)
    sides = np.linalg.norm(lifted.p_D - np.roll(lifted.p_D, -1, axis=0), axis=1)
    assert lifted.length == pytest.approx(sides.sum())
    np.testing.assert_allclose(lifted.s, np.concatenate([[0], np.cumsum(sides)[:-1]]), atol=1e-15)


def test_a_frame_of_two_hands(field):
    frame = prostm.TargetFrame([field, field])
    result = prostm.Planner(paths=4).plan(frame)
    assert sorted(path.patch for path in result.paths) == [0, 0, 1, 1]
    for patch in (0, 1):
        own = [path for path in result.paths if path.patch == patch]
        planned = prostm.quasi_static_field(result.plan, field, patch=patch)
        np.testing.assert_allclose(planned, eq1(own, field), rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(result.quasi_static_field(patch), planned, atol=0.1 * prostm.max_pressure(field))
        played = prostm.score_field(field, result.quasi_static_field(patch), result.metrics(patch).coverage)
        assert result.metrics(patch).as_dict() == played.as_dict()
    with pytest.raises(ValueError, match="patch"):
        result.metrics(2)
    with pytest.raises(ValueError, match="one TargetField"):
        result.write("frame.json")


def test_emission_follows_the_path_at_its_speed(field):
    result = prostm.plan(field, paths=1)
    full_scale = 1.4 * prostm.max_pressure(field)
    positions, intensities = prostm.emit(result.plan, field, 0.1, full_scale)
    assert positions.shape == (4000, 1, 3) and intensities.shape == (4000, 1)
    assert positions.dtype == intensities.dtype == np.float32
    assert intensities[0, 0] <= 1 / 40 and intensities.min() >= 0 and 0.5 < intensities.max() <= 1
    assert np.abs(np.diff(intensities, axis=0)).max() <= 1 / 40 + 1e-6

    # once active: 7 m/s, with an integer number of samples per lap, in the plane 200 mm above the array
    p = positions[400:, 0].astype(float)
    lap = int(np.ceil(result.paths[0].length / (7 / 40e3)))
    np.testing.assert_allclose(p[lap:], p[:-lap], atol=1e-6)
    steps = np.linalg.norm(np.diff(p, axis=0), axis=1)
    assert steps.max() <= 7 / 40e3 + 1e-6
    np.testing.assert_allclose(p[:, 2], 0.2, atol=1e-6)

    # each sample lies on the path, with the intensity of the drive law
    a, b = result.paths[0].points, np.roll(result.paths[0].points, -1, axis=0)
    pr, qr = result.paths[0].pressure, np.roll(result.paths[0].pressure, -1)
    for k in range(400, 4000, 37):
        edge = b - a
        t = np.clip(((positions[k, 0, :2] - a) * edge).sum(1) / (edge * edge).sum(1), 0, 1)
        d = np.linalg.norm(a + t[:, None] * edge - positions[k, 0, :2], axis=1)
        i = d.argmin()
        assert d[i] < 1e-6
        wanted = prostm.drive_intensity(pr[i] + t[i] * (qr[i] - pr[i]), full_scale)
        assert intensities[k, 0] == pytest.approx(float(wanted), abs=2e-3)


def test_an_emitter_step_by_step(field):
    planner = prostm.Planner(paths=2)
    emitter = prostm.PathEmitter(full_scale_pressure=1.4, foci=3)
    assert emitter.foci == 3 and emitter.sample_rate == 40e3 and emitter.settings.foci == 3
    lifted = prostm.lift(planner.plan(field).plan, field)
    lifted.id = 12
    emitter.submit(lifted)
    blocks = [emitter.fill(40 * block, 40) for block in range(50)]
    intensities = np.concatenate([intensity for _, intensity in blocks])
    assert intensities[1000:].max(axis=0).astype(bool).sum() == 2
    emitter.lose()
    assert emitter.fill(2000, 2000)[1][-1].max() == 0
    stats = emitter.stats()
    assert stats.samples == 4000 * 3 and stats.laps_started > 2 and stats.max_focus_step <= 0.2e-3
    report = emitter.next_take_over()
    assert report.plan == 12 and report.first_sample >= 0 and report.redrawn_sample > 0
    assert emitter.next_take_over() is None

    # the block size does not matter
    whole = prostm.PathEmitter(full_scale_pressure=1.4, foci=3)
    whole.submit(lifted)
    positions, intensities_of_whole = whole.fill(0, 2000)
    np.testing.assert_array_equal(intensities_of_whole, intensities)
    np.testing.assert_array_equal(positions, np.concatenate([position for position, _ in blocks]))


def test_the_trace_holds_the_stages_of_fig_2(field):
    result = prostm.plan(field, "paper", trace=True)
    trace = result.trace
    k = result.stats.clusters
    assert trace.clusters.shape == (k, 2) and trace.cluster_mass.shape == (k,)
    p = field.pressure[field.skin] / prostm.max_pressure(field)
    assert trace.cluster_mass.sum() == pytest.approx(p[p >= 0.01].sum())
    assert sorted(trace.tour) == list(range(k))
    assert len(trace.split) == len(result.paths)
    used = np.concatenate(trace.split)
    assert len(set(used)) == len(used)
    assert prostm.plan(field, "paper").trace is None
