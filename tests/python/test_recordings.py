"""Recordings: frames by number, targets and plans as read by h5py, and the reconstruction of a run."""

import json
import pickle
import subprocess
import sys
import threading

import h5py
import numpy as np
import prostm
import pytest


@pytest.fixture(scope="module")
def run(program, tmp_path_factory):
    """Returns the recording of a short run."""
    path = tmp_path_factory.mktemp("run") / "run.h5"
    program("run", "--scene", "four-plumes", "--stepped", "--seconds", 1.6, "--record", path)
    return path


def planned_frame(path):
    with h5py.File(path) as file:
        return int(np.flatnonzero(file["plan/paths"][:] > 0)[-1])


def recorded_target(file, frame):
    """Returns the pressures, heights and origin of the first patch of a frame, as read by h5py."""
    patch = file["frame/first_patch"][frame]
    rows, cols, at = (file["target"][name][patch] for name in ("rows", "cols", "offset"))
    cells = slice(at, at + rows * cols)
    pressure, height = (file["target"][name][cells].reshape(rows, cols) for name in ("pressure", "height"))
    return pressure, height, file["target/origin"][patch], file["target/pose"][patch]


def test_a_frame_is_read_by_its_number(run):
    frame = planned_frame(run)
    with h5py.File(run) as file:
        pressure, height, origin, pose = recorded_target(file, frame)
        first = recorded_target(file, 0)[0] if file["frame/patches"][0] else None
        frames = len(file["frame/time"])
    field = prostm.read_field(run, frame=frame)
    np.testing.assert_array_equal(field.pressure, pressure)
    np.testing.assert_array_equal(field.height, height)
    np.testing.assert_array_equal(field.origin, origin)
    np.testing.assert_array_equal(field.X_DP, pose)
    if first is not None:
        np.testing.assert_array_equal(prostm.read_field(run).pressure, first)
    for result in (prostm.plan(run, frame=frame), prostm.plan(run, "fast", frame=frame),
                   prostm.Planner().plan(run, frame=frame), prostm.AmPlanner().plan(str(run), frame=frame),
                   prostm.plan(run, method="am", frame=frame)):
        np.testing.assert_array_equal(result.target.pressure, pressure)
    for call in (prostm.plan, prostm.Planner().plan, prostm.AmPlanner().plan, prostm.read_field):
        with pytest.raises(prostm.InputError, match=f"run.h5 has no frame 999; it has {frames} frames, counted from 0"):
            call(run, frame=999)


def test_only_files_have_frames(field, tmp_path):
    np.save(tmp_path / "x.npy", np.ones((4, 4)))
    assert prostm.Planner().plan(tmp_path / "x.npy", cell_mm=5).target.shape == (4, 4)
    with pytest.raises(prostm.InputError, match="holds one field"):
        prostm.plan(tmp_path / "x.npy", cell_mm=5, frame=3)
    with pytest.raises(ValueError, match="frame belongs to the name of a recording"):
        prostm.plan(field, frame=3)
    for options in ({"frame": 3}, {"cell_mm": 5}):
        with pytest.raises(ValueError, match="belong to the name of a file, not to a TargetField"):
            prostm.Planner().plan(field, **options)


def test_targets_and_plans_match_the_file(run):
    recording = prostm.Recording(run)
    with h5py.File(run) as file:
        np.testing.assert_array_equal(recording.time, file["frame/time"][:])
        assert recording.frames == len(file["frame/time"]) and recording.scene == "four-plumes"
        assert recording.settings == json.loads(file.attrs["settings"])
        for frame in range(recording.frames):
            target, paths = recording.target(frame), file["plan/paths"][frame]
            assert target.time == file["frame/time"][frame] and len(target.patches) == file["frame/patches"][frame]
            if target.patches:
                np.testing.assert_array_equal(target.patches[0].pressure, recorded_target(file, frame)[0])
            result = recording.plan(frame)
            if paths == -1:
                assert result is None
                continue
            assert len(result.paths) == paths and result.status == prostm.PlanStatus.Planned
            assert result.stats.total == file["plan/stage_time"][frame, 6]
            assert result.stats.cost == file["plan/cost"][frame]
            for k, path in enumerate(result.paths):
                n = file["plan/samples"][frame, k]
                np.testing.assert_array_equal(path.points, file["plan/points"][frame, k, :n])
                np.testing.assert_array_equal(path.pressure, file["plan/pressure"][frame, k, :n])
                assert path.patch == file["plan/patch"][frame, k]
                assert [path.length, path.speed, path.period] == [file["plan"][name][frame, k]
                                                                  for name in ("length", "speed", "period")]
    assert "frames)" in repr(recording)
    for call in (recording.target, recording.plan):
        for frame in (-1, recording.frames):
            with pytest.raises(prostm.InputError, match=f"has no frame {frame}; it has {recording.frames} frames"):
                call(frame)


def test_the_reconstruction_matches_the_run(run):
    frame = planned_frame(run)
    recording = prostm.Recording(run)
    result = recording.plan(frame)
    target = result.target.patches[0]
    with h5py.File(run) as file:
        sigma, full_scale = file["plan/sigma"][frame, 0], file["plan/full_scale_pressure"][frame]
        assert np.isnan(file["plan/sigma"][frame, 1])
        assert json.loads(file.attrs["summary"])["full_scale_pressure_pa"] == full_scale
        assert np.isnan(file["plan/full_scale_pressure"][:][file["plan/paths"][:] < 0]).all()
    assert 4e-3 < sigma < 12e-3 and sigma != recording.settings["plan"]["sigma"]  # the width of the array's focus
    assert result.emission.full_scale_pressure == full_scale
    rendered = result.quasi_static_field()
    assert rendered.shape == target.shape
    planned = prostm.quasi_static_field(result.plan, target, sigma=sigma)
    np.testing.assert_allclose(rendered, planned, atol=0.1 * prostm.max_pressure(target))
    metrics = prostm.score_field(target, rendered)
    assert metrics.rmse == pytest.approx(result.metrics().rmse, rel=1e-9) and metrics.correlation > 0.8
    # with another full scale the played plan differs
    weak = prostm.EmitSettings(full_scale_pressure=0.2 * full_scale)
    assert result.quasi_static_field(emission=weak).max() < rendered.max()
    positions, intensities = prostm.emit(result, seconds=0.1)
    assert positions.shape == (4000, len(result.paths), 3) and 0 < intensities.max() <= 1


def test_both_parts_of_the_pressure(program, run, tmp_path):
    settings, path = tmp_path / "parts.toml", tmp_path / "parts.h5"
    settings.write_text("[contact]\nparts = true\n[fluid]\ncells = 40\n")
    program("run", "--scene", "four-plumes", "--stepped", "--seconds", 1.6, "--settings", settings, "--record", path)
    recording = prostm.Recording(path)
    target = recording.target(planned_frame(path)).patches[0]
    assert target.smoke.shape == target.movement.shape == target.shape
    assert target.movement.any() and not target.movement[~target.skin].any()
    whole = np.maximum(target.smoke + target.movement, 0)
    np.testing.assert_allclose(target.pressure[target.skin], whole[target.skin], atol=1e-6)
    assert not target.smoke.flags.writeable
    twin = pickle.loads(pickle.dumps(target))
    np.testing.assert_array_equal(twin.smoke, target.smoke)
    np.testing.assert_array_equal(twin.movement, target.movement)
    with h5py.File(path) as file:
        assert file["target/smoke"].attrs["unit"] == file["target/movement"].attrs["unit"] == "Pa"
        assert file["target/smoke"].shape == file["target/pressure"].shape
    without = prostm.Recording(run).target(planned_frame(run)).patches[0]
    assert without.smoke is None and without.movement is None


def test_a_recording_of_foci(program, tmp_path):
    (tmp_path / "am.toml").write_text('[pipeline]\nmethod = "am"\n')
    program("run", "--scene", "four-plumes", "--stepped", "--seconds", 1.6, "--settings", tmp_path / "am.toml",
            "--record", tmp_path / "am.h5")
    recording = prostm.Recording(tmp_path / "am.h5")
    with h5py.File(tmp_path / "am.h5") as file:
        foci = file["plan/foci"][:]
        frame = int(np.flatnonzero(foci > 0)[-1])
        result = recording.plan(frame)
        assert isinstance(result.settings, prostm.AmSettings) and not result.paths and len(result.foci) == foci[frame]
        for k, focus in enumerate(result.foci):
            np.testing.assert_array_equal(focus.position, file["plan/focus_position"][frame, k])
            assert focus.pressure == file["plan/focus_pressure"][frame, k]
            assert focus.phase == file["plan/focus_phase"][frame, k] == 0
    assert result.quasi_static_field().max() > 0


def test_loops_and_phases(run, tmp_path):
    frame, path = planned_frame(run), tmp_path / "loop.h5"
    path.write_bytes(run.read_bytes())
    with h5py.File(path, "r+") as file:
        assert file["plan/loop"].attrs["unit"] == "s" and (file["plan/loop"][:] == 0).all()
        file["plan/loop"][frame] = 0.02
    assert prostm.Recording(run).plan(frame).plan.loop == 0 and prostm.Recording(path).plan(frame).plan.loop == 0.02
    with h5py.File(path, "r+") as file:
        file["plan/loop"][frame] = -1.0
    with pytest.raises(prostm.InputError, match="is damaged"):
        prostm.Recording(path).plan(frame)
    # recordings of earlier versions have neither
    with h5py.File(path, "r+") as file:
        del file["plan/loop"], file["plan/focus_phase"]
    assert prostm.Recording(path).plan(frame).plan.loop == 0


@pytest.mark.parametrize("mode", ["r", "r+"])
def test_a_file_open_in_h5py_is_read(run, mode):
    frame = planned_frame(run)
    with h5py.File(run, mode) as file:
        np.testing.assert_array_equal(prostm.read_field(run, frame=frame).pressure, recorded_target(file, frame)[0])
        assert prostm.Recording(run).frames == len(file["frame/time"])
        # our handle is closed again, and h5py's is not
        np.testing.assert_array_equal(recorded_target(file, frame)[0], recorded_target(file, frame)[0])


def test_a_file_open_with_another_close_degree_is_read(run):
    access = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    access.set_fclose_degree(h5py.h5f.CLOSE_STRONG)
    file = h5py.File(h5py.h5f.open(bytes(run), h5py.h5f.ACC_RDONLY, access))
    assert prostm.Recording(run).frames == len(file["frame/time"])
    assert file["frame/time"][0] >= 0
    file.close()


def test_a_file_being_written_is_reported_as_such(run):
    code = "import h5py, sys; file = h5py.File(sys.argv[1], 'r+'); print(flush=True); sys.stdin.read()"
    writer = subprocess.Popen([sys.executable, "-c", code, run], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              text=True)
    try:
        writer.stdout.read(1)
        for call in (prostm.read_field, prostm.Recording, prostm.plan):
            with pytest.raises(prostm.InputError, match="run.h5 is open for writing in another program"):
                call(run)
    finally:
        writer.communicate("")
    assert prostm.Recording(run).frames > 0


def test_threads_read_alongside_h5py(run):
    """HDF5 allows one thread at a time; h5py releases the interpreter's lock while it reads."""
    frame, wrong, done = planned_frame(run), [], []
    recording = prostm.Recording(run)
    expected = recording.target(frame).patches[0].pressure

    def work(read):
        for _ in range(60):
            if not np.array_equal(read(), expected, equal_nan=True):
                wrong.append(read)
        done.append(read)

    with h5py.File(run) as file:
        readers = [lambda: recorded_target(file, frame)[0], lambda: recording.target(frame).patches[0].pressure,
                   lambda: prostm.read_field(run, frame=frame).pressure,
                   lambda: prostm.Recording(run).target(frame).patches[0].pressure]
        threads = [threading.Thread(target=work, args=[read]) for read in readers]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert len(done) == 4 and not wrong


def test_files_that_are_not_recordings(tmp_path):
    (tmp_path / "text.h5").write_text("hello")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1
    for name, words in [("text.h5", "HDF5"), ("other.h5", "prostm-recording/1"), ("absent.h5", "absent.h5")]:
        with pytest.raises(prostm.InputError, match=words):
            prostm.Recording(tmp_path / name)


def test_settings_of_another_version_are_reported_as_such(run, tmp_path):
    copy = tmp_path / "copy.h5"
    copy.write_bytes(run.read_bytes())
    frame = planned_frame(run)
    with h5py.File(copy, "r+") as file:
        settings = json.loads(file.attrs["settings"])
        settings["plan"]["pathz"] = 4
        file.attrs["settings"] = json.dumps(settings)
    with pytest.raises(prostm.InputError, match="copy.h5.*settings.*pathz"):
        prostm.Recording(copy).plan(frame)
    with h5py.File(copy, "r+") as file:
        file.attrs["settings"] = "{"
    with pytest.raises(prostm.InputError, match="is not JSON"):
        prostm.Recording(copy)


def test_plans_of_an_earlier_version_are_reported_as_such(run, tmp_path):
    earlier = tmp_path / "earlier.h5"
    earlier.write_bytes(run.read_bytes())
    with h5py.File(earlier, "r+") as file:
        del file["plan/sigma"]
    recording = prostm.Recording(earlier)
    assert recording.target(planned_frame(run)).patches
    with pytest.raises(prostm.InputError, match="has no dataset /plan/sigma, so its plans cannot be read: an earlier version"):
        recording.plan(planned_frame(run))


def test_the_gate_of_a_frame_matches_the_file(run, tmp_path):
    recording, last = prostm.Recording(run), planned_frame(run)
    result = recording.gate(last)
    with h5py.File(run) as file:
        gate = {name: file["gate"][name][last] for name in file["gate"]}
        names = file["gate/problem"].attrs["meaning"]
    assert result.passed == (gate["passed"] == 1)
    assert f"{gate['problem']} {result.problem}" in (names if isinstance(names, str) else names.decode())
    assert result.sentence in repr(result) and result.sentence.endswith(".")
    count = gate["maxima"]
    assert result.shape.maxima.shape == (count, 3)
    np.testing.assert_array_equal(result.shape.maxima[:, :2], gate["position"][:count])
    np.testing.assert_array_equal(result.shape.maxima[:, 2], gate["pressure"][:count])
    assert result.share == gate["share"]
    # the shape can be measured from the target alone
    measured = prostm.field_shape(recording.target(last).patches[0])
    for name in ("largest", "balance", "saddle", "least_spacing", "most_spacing", "area", "force"):
        assert getattr(result.shape, name) == gate[name] == getattr(measured, name)
    with pytest.raises(prostm.InputError, match="has no frame 999"):
        recording.gate(999)


def test_a_recording_without_a_gate_has_none(run, program, tmp_path):
    earlier = tmp_path / "earlier.h5"
    earlier.write_bytes(run.read_bytes())
    with h5py.File(earlier, "r+") as file:
        del file["gate"]
    assert prostm.Recording(earlier).gate(0) is None
    # still air has no stimulus
    program("run", "--scene", "still-air", "--stepped", "--seconds", 0.2, "--record", tmp_path / "air.h5")
    assert prostm.Recording(tmp_path / "air.h5").gate(0) is None
