"""Bad input gets one clear sentence and exit status 2, without crashes or half-written files."""

import copy
import json
import os
import resource
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

from conftest import ROOT

GOOD = {
    "format": "prostm-field/1",
    "cell_mm": 5,
    "origin_mm": [0, 0],
    "rows": 2,
    "cols": 3,
    "pressure": [[1, 2, 3], [3, 2, 1]],
}


def changed(**changes):
    field = dict(GOOD, **changes)
    return json.dumps({k: v for k, v in field.items() if v is not None})


@pytest.mark.parametrize(
    "text, words",
    [
        ("", ["empty"]),
        (changed()[:60], []),
        ("[" * 100000, []),
        (changed(format="prostm-plan/1"), ["prostm-field/1"]),
        (changed(cell_mm=0), ["cell"]),
        (changed(cell_mm=-5), ["cell"]),
        (changed(cell_mm="five"), ["cell"]),
        (changed(pressure=[[1, 2, 3], [3, -2, 1]]), ["-2"]),
        (changed(pressure=[[1, 2, 3], [3, 2]]), ["row"]),
        (changed(pressure=[[1, 2, 3]]), ["row"]),
        (changed(pressure=[[1, 2, 3], [3, "two", 1]]), []),
        (changed().replace("[3, 2, 1]", "[3, 1e999, 1]"), []),
        (changed(pressure=None), ["pressure"]),
        (changed(rows=20000, cols=20000, pressure=[[0] * 10]), ["20000"]),
        (changed(height_mm=[[0, 0, 0]]), ["height"]),
        (changed(weight=[[1, 1, 1]]), ["weight", "rows"]),
        (changed(weight=[[1, 1, 1], [1, -4, 1]]), ["weight", "-4", "from 0"]),
        (changed(weight=[[1, 1, 1], [1, None, 1]]), ["weight", "null"]),
        (changed(weight=[[0, 0, 0], [0, 0, 0]]), ["weight", "above 0"]),
        (changed(weight="all"), ["weight"]),
        (changed(plane={"origin_mm": [0, 0, 200], "x": [1, 0, 0], "y": [1, 0, 0]}), ["plane"]),
    ],
)
def test_bad_field_json(refuses, tmp_path, text, words):
    path, out = tmp_path / "bad.json", tmp_path / "out.json"
    path.write_text(text)
    refuses("plan", path, "--json", out, words=["bad.json", *words])
    assert not out.exists() and os.listdir(tmp_path) == ["bad.json"]


def test_missing_file_folder_and_unknown_ending(refuses, tmp_path):
    refuses("plan", tmp_path / "none.json", words=["none.json"])
    (tmp_path / "folder.json").mkdir()
    refuses("plan", tmp_path / "folder.json", words=["folder.json"])
    (tmp_path / "field.txt").write_text("1 2 3")
    refuses("plan", tmp_path / "field.txt", words=["field.txt", ".json"])


def test_bad_npy_and_png(refuses, tmp_path):
    path = tmp_path / "f.npy"
    np.save(path, np.ones((4, 5)))
    refuses("plan", path, words=["--cell-mm"])
    refuses("plan", path, "--cell-mm", "0", words=["0"])
    refuses("plan", path, "--cell-mm", "nan")
    np.save(path, np.ones(5))
    refuses("plan", path, "--cell-mm", "5", words=["f.npy"])
    np.save(path, -np.ones((4, 5)))
    refuses("plan", path, "--cell-mm", "5", words=["-1"])
    path.write_bytes(b"\x93NUMPY\x01\x00")
    refuses("plan", path, "--cell-mm", "5", words=["f.npy"])
    png = tmp_path / "f.png"
    png.write_bytes(b"\x89PNG\r\n\x1a\n" + b"\0" * 30)
    refuses("plan", png, "--cell-mm", "5", words=["f.png"])
    h5 = tmp_path / "f.h5"
    h5.write_bytes(b"not a recording")
    refuses("plan", h5, words=["f.h5"])
    refuses("bench", h5, words=["f.h5"])


def hand_lines():
    header = {"format": "hand-frames", "version": 1, "units": "m"}
    # straight fingers side by side
    finger = [0] * 6 + [1 + j // 5 for j in range(20)]
    along = [0, 0, 0, 1, 2, 3] + [j % 5 for j in range(20)]
    position = [c for f, a in zip(finger, along) for c in (0.02 * f, 0.2, -0.03 * a)]
    hand = {"id": 1, "side": "R", "conf": 1, "inferred": 0, "p": position, "q": [0, 0, 0, 1] * 26, "r": [0.01] * 26}
    return header, [{"t": 0.01 * i, "hands": [dict(hand)]} for i in range(5)]


@pytest.mark.parametrize("fault", ["joints", "nan", "infinite", "backwards", "empty", "truncated", "no frames"])
def test_bad_recordings(refuses, tmp_path, fault):
    header, frames = hand_lines()
    frames = frames[:3]  # a quarter of which may be bad
    if fault == "joints":
        frames[2]["hands"][0]["p"] = frames[2]["hands"][0]["p"][:75]
    if fault == "nan":
        frames[2]["hands"][0]["p"][4] = None
    if fault == "backwards":
        frames[2]["t"] = 0.001
    if fault == "no frames":
        frames = []
    text = "\n".join(json.dumps(line) for line in [header] + frames) + "\n"
    if fault == "infinite":
        text = text.replace("0.03", "1e999", 1)
    if fault == "empty":
        text = ""
    if fault == "truncated":
        text = text[:-40]
    path = tmp_path / "bad.hands.jsonl"
    path.write_text(text)
    refuses("run", "--hand", path, "--grid", "32", words=["bad.hands.jsonl"])


def test_a_bad_hand_is_counted(prostm, tmp_path):
    header, frames = hand_lines()
    frames[2] = copy.deepcopy(frames[2])
    frames[2]["hands"][0]["p"][4] = None
    path = tmp_path / "one.hands.jsonl"
    path.write_text("\n".join(json.dumps(line) for line in [header] + frames) + "\n")
    run = ["run", "--hand", path, "--grid", "32", "--seconds", "0.1", "--stepped", "--json", "-"]
    result = json.loads(prostm(*run).stdout)
    counts = result["hand_file"]
    assert counts["frames"] == 5 and counts["dropped"] == 0 and counts["dropped_hands"] == 1
    assert counts["faults"]["member"] == 1 and "line 4" in counts["first"]
    assert any("were dropped (1 member)" in sentence for sentence in result["verdict"]["sentences"])
    capture = ["capture", "--hand", path, "--grid", "32", "--frames", "1", "--out", "one.h5"]
    warned = prostm(*capture).stderr
    assert "warning: 0 of 5 frames and 1 of 5 hands in the recording were dropped" in warned


def test_a_recording_whose_hands_are_all_unsure(refuses, prostm, tmp_path):
    header, frames = hand_lines()
    for frame in frames:
        frame["hands"][0]["conf"] = 0.05
    path = tmp_path / "unsure.hands.jsonl"
    path.write_text("\n".join(json.dumps(line) for line in [header] + frames) + "\n")
    run = ["run", "--hand", path, "--grid", "32", "--seconds", "0.1", "--stepped"]
    refuses(*run, words=["all 5 hands", "0.05", "least_confidence = 0.1"])
    settings = tmp_path / "all.toml"
    settings.write_text("[track]\nleast_confidence = 0\n")
    prostm(*run, "--settings", settings)


@pytest.mark.parametrize(
    "args, words",
    [
        (["run", "--scene", "five-plumes"], ["five-plumes", "one-plume", "four-plumes", "still-air"]),
        (["run", "--device", "toaster"], ["toaster"]),
        (["run", "--device", "ultraleap"], ["not in this build"]),
        (["run", "--device", "autd3://127.0.0.1:1"], ["nothing listens there", "RemoteServer"]),
        (["run", "--method", "fm"], ["fm", "pro-stm", "am"]),
        (["run", "--method", "am", "--preset", "best"], ["--preset", "pro-stm"]),
        (["run", "--method", "am", "--budget-ms", "3"], ["--budget-ms", "pro-stm"]),
        (["run", "--method", "am", "--paths", "9"], ["--paths = 9", "between 1 and 8"]),
        (["run", "--hand", "leap://"], ["names no host", "leap://127.0.0.1:6437"]),
        (["run", "--hand", "leap://127.0.0.1:many"], ["port", "1 to 65535"]),
        (["run", "--hand", "leap://nonsense.invalid"], ["host", "nonsense.invalid", "is unknown"]),
        (["run", "--hand", "leap://127.0.0.1:6437", "--stepped"], ["real time", "--stepped"]),
        (["capture", "--hand", "openxr", "--out", "x.h5"], ["real time"]),
        (["run", "--hand", "page"], ["--hand page", "--view"]),
        (["run", "--tracker", "roof"], ["roof", "centre", "ultraleap-kit", ".json"]),
        (["run", "--tracker", "none.json"], ["none.json"]),
        (["run", "--hand", "/nowhere/hand.jsonl"], ["/nowhere/hand.jsonl"]),
        (["run", "--seconds", "-1"], ["seconds"]),
        (["run", "--seconds", "9", "--figure-at", "-3", "--figure", "f.png"], ["--figure-at", "9 s"]),
        (["run", "--seconds", "9", "--figure-at", "nan", "--figure", "f.png"], ["--figure-at", "nan"]),
        (["run", "--grid", "161"], ["161"]),
        (["run", "--paths", "9"], ["9"]),
        (["run", "--device", "a"], ["device 'a' is unknown: it must be sim"]),
        (["run", "--seed", "-1"], ["--seed = -1", "between 0"]),
        (["run", "--preset", "worst"], ["worst"]),
        (["run", "--budget-ms", "-1"], ["budget", "between 0"]),
        (["run", "--budget-ms", "nan"], ["budget", "between 0"]),
        (["run", "--budget-ms", "5", "--preset", "fast"], ["budget", "best", "fast"]),
        (["capture", "--frames", "0", "--out", "x.h5"], ["frames"]),
        (["report"], ["--out is missing", "prostm report --help"]),
        (["report", "--out", "x", "--seed", "-1"], ["--seed = -1", "between 0"]),
        (["report", "--out", "x", "--paper-data", "nowhere"], ["--paper-data nowhere is not a folder"]),
        (["play", "x"], ["not built yet"]),
        (["study"], ["study needs one of its commands: check, run, status, analyse, preregister, power, simulate", "prostm study --help"]),
        (["study", "analize"], ['study has no command "analize"; did you mean "analyse"? See prostm study --help']),
        (["study", "run", "p.toml"], ["--participant is missing"]),
        (["study", "simulate", "--trials", "15"], ["trials = 15 must be even"]),
        (["study", "simulate", "--participants", "1"], ["participants = 1", "between 2 and 1000"]),
        (["study", "simulate", "--hands", "0"], ["--hands = 0", "between 1 and 100"]),
        (["study", "simulate", "--noise", "0"], ["--noise = 0", "between 0.01 and 100"]),
        (["study", "simulate", "--preset", "worst"], ["worst"]),
        (["study", "simulate", "--grid", "5"], ["--grid = 5"]),
        (["study", "simulate", "--paper-data", "nowhere"], ["nowhere/fig4.json"]),
        (["study", "simulate", "--answers", "x", "--json", "x"], ["--json", "--answers"]),
        (["study", "analyse"], ["study analyse needs a file", "prostm study analyse --help"]),
        (["study", "analyse", "--levle", "0.9"], ['study analyse has no option "--levle"; did you mean "--level"?']),
        (["study", "analyse", str(ROOT / "data" / "made-up-answers.csv"), "--level", "3"], ["level = 3", "0.9999"]),
        (["study", "analyse", str(ROOT / "data" / "foci.json")], ["foci.json", "fig4"]),
        (["study", "analyse", str(ROOT / "data" / "palm.npy")], ["palm.npy", ".csv"]),
    ],
)
def test_bad_options(refuses, args, words):
    refuses(*args, words=[*words])


@pytest.mark.parametrize(
    "text, words",
    [
        ("[plan]\npathz = 3\n", ["pathz", "paths"]),
        ("[plam]\npaths = 3\n", ["plam", "plan"]),
        ('[plan]\npaths = "three"\n', ["paths"]),
        ("[plan]\npaths = 99\n", ["99"]),
        ("[plan]\nsigma = nan\n", ["sigma"]),
        ("[plan]\nseed = -1\n", ["plan.seed", "-1"]),
        ("[plan]\n\nspeed = 800\n", ["s.toml, line 3: plan.speed = 800 m/s must be between 0.1 and 8 m/s"]),
        ("[fluid]\ncells = 30\n", ["s.toml, line 2: fluid.cells = 30 must be between 32 and 160"]),
        ("speed = 8\n",
         ['s.toml, line 1: "speed" is outside a group of settings; did you mean [plan] speed?']),
        ("sigma = 8e-3\n", ["did you mean [plan] sigma or [am] sigma?"]),
        ("[plan\n", ["s.toml"]),
    ],
)
def test_bad_settings(refuses, tmp_path, text, words):
    (tmp_path / "s.toml").write_text(text)
    field = tmp_path / "field.json"
    field.write_text(changed())
    refuses("plan", field, "--settings", tmp_path / "s.toml", words=[*words])


def test_devices_name_the_openxr_runtime_that_is_missing(prostm, monkeypatch, tmp_path):
    monkeypatch.setenv("XR_RUNTIME_JSON", str(tmp_path / "none.json"))
    kinds = {row["kind"]: row for row in json.loads(prostm("devices", "--json", "-").stdout)}
    assert not kinds["openxr"]["available"] and "no OpenXR runtime" in kinds["openxr"]["detail"]


@pytest.mark.parametrize(
    "changes, words",
    [
        ({}, None),
        ({"format": "prostm-plan/1"}, ["prostm-pose/1"]),
        ({"position_mm": [0, 0]}, ["position_mm", "3"]),
        ({"position_mm": [0, 0, 1e6]}, ["position_mm", "5000"]),
        ({"quaternion": [0, 0, 0, 0.5]}, ["quaternion", "length 0.5"]),
        ({"quaternion": [0, 0, 0, None]}, ["quaternion", "number"]),
    ],
)
def test_pose_files(refuses, prostm, tmp_path, changes, words):
    pose = {"format": "prostm-pose/1", "position_mm": [0, 121, 0], "quaternion": [1, 0, 0, 0]}
    (tmp_path / "pose.json").write_text(json.dumps({**pose, **changes}))
    arguments = ("run", "--grid", "32", "--seconds", "0.2", "--stepped", "--tracker", "pose.json")
    if words is None:
        prostm(*arguments)
    else:
        refuses(*arguments, words=["pose.json", *words])


def test_unwritable_output(refuses, tmp_path):
    field = tmp_path / "field.json"
    field.write_text(changed())
    gone = tmp_path / "no" / "such" / "folder"
    refuses("plan", field, "--json", gone / "plan.json", words=["folder"])
    refuses("plan", field, "--figure", gone / "plan.png", words=["folder"])
    refuses("run", "--grid", "32", "--seconds", "1", "--record", gone / "run.h5", words=["folder"])
    refuses("capture", "--grid", "32", "--out", gone / "run.h5", words=["folder"])
    refuses("plan", field, "--figure", tmp_path / "plan.gif", words=[".png"])


def test_full_disk(program, prostm, tmp_path):
    """A file size limit emulates a full disk: both make a write fail part-way."""
    field = tmp_path / "field.json"
    field.write_text(json.dumps(dict(GOOD, rows=40, cols=40, pressure=np.random.default_rng(1).random((40, 40)).tolist())))
    # the first figure on a machine also writes the system's font cache, which must not reach the limit
    prostm("plan", field, "--figure", tmp_path / "first.png")

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

    for out in (["plan", field, "--json", tmp_path / "o.json"], ["plan", field, "--figure", tmp_path / "o.png"],
                ["capture", "--grid", "32", "--frames", "30", "--out", tmp_path / "o.h5"]):
        done = subprocess.run([str(program), *map(str, out)], capture_output=True, text=True, preexec_fn=limit,
                              restore_signals=False, timeout=120)
        assert done.returncode == 2, done.stderr
        lines = done.stderr.splitlines()
        assert len(lines) == 1 and lines[0].startswith("prostm: ") and out[-1].name in lines[0]
        assert not (tmp_path / out[-1].name).exists()


@pytest.mark.realtime
def test_a_lack_of_memory_is_reported_as_such(program, tmp_path):
    for arguments in (["run", "--seconds", "1"], ["capture", "--frames", "1", "--out", "o.h5"]):
        done = subprocess.run([str(program), *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=60,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (100 << 20, 100 << 20)))
        assert done.returncode == 2 and done.stderr.startswith("prostm: there is not enough memory"), done.stderr


def test_a_killed_recording_still_opens(program, tmp_path):
    recording = tmp_path / "run.h5"
    running = subprocess.Popen(
        [str(program), "run", "--grid", "32", "--seconds", "600", "--record", str(recording)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(5.0)
    running.kill()
    running.wait(timeout=30)
    assert not recording.exists()
    part = list(tmp_path.glob("*.part.h5"))
    assert len(part) == 1
    with h5py.File(part[0]) as h5:
        assert len(h5.keys()) > 0


def foci_file(tmp_path, *positions, pressure=100):
    path = tmp_path / "foci.json"
    foci = [{"position_mm": p, "pressure_pa": pressure} for p in positions]
    path.write_text(json.dumps({"format": "prostm-foci/1", "foci": foci}))
    return path


@pytest.mark.parametrize(
    "positions, words",
    [
        ([], ["0 focal points"]),
        ([[x, 0, 200] for x in range(1000)], ["1000", "256"]),
        ([[0, 0, -200]], ["focal point 1", "behind the array"]),
        ([[0, 0, 200], [5.25, 5.25, 1]], ["focal point 2", "on transducer"]),
        ([[0, 0, 200], [0, 0, 200]], ["focal point 2", "focal point 1"]),
        ([[0, 0, None]], ["position_mm"]),
        ([[0, 0]], ["position_mm"]),
    ],
)
def test_bad_foci(refuses, tmp_path, positions, words):
    refuses("solve", foci_file(tmp_path, *positions), words=words)


def test_solve_rejects_unknown_values(refuses, tmp_path):
    good = foci_file(tmp_path, [0, 0, 200])
    refuses("solve", good, "--array", "disc", words=["disc", "usx", "autd3"])
    refuses("run", "--array", "disc", words=["disc", "usx", "autd3"])
    refuses("solve", good, "--solver", "magic", words=["magic", "gs-pat"])
    refuses("solve", foci_file(tmp_path, [0, 0, 200], pressure=0), words=["above 0 Pa"])
    (tmp_path / "array.json").write_text('{"format": "prostm-array/1", "name": "none", "frequency_hz": 40000,'
                                         ' "radius_mm": 4.5, "directivity": "omni", "amplitude_pa_m": 3, "transducers_mm": []}')
    refuses("solve", good, "--array", tmp_path / "array.json", words=["0 transducers"])


def test_field_rejects_plans_without_a_field(refuses, prostm, tmp_path):
    field, plan = tmp_path / "field.json", tmp_path / "plan.json"
    field.write_text(changed())
    prostm("plan", field, "--json", plan)
    refuses("field", words=["plan", "--widths"])
    refuses("field", plan, "--widths", words=["--widths"])
    refuses("field", field, words=["prostm-plan/1"])
    refuses("field", tmp_path / "none.json", words=["none.json"])
    refuses("field", plan, "--array", "disc", words=["disc", "usx", "autd3"])
    refuses("field", plan, "--solver", "magic", words=["magic", "gs-pat"])
    refuses("field", plan, "--full-scale-pa", "-3", words=["full_scale_pa", "-3"])
    refuses("field", plan, "--cell-mm", "5", words=["--field"])
    refuses("field", plan, "--figure", tmp_path / "f.gif", words=[".png"])
    other = tmp_path / "other.json"
    other.write_text(changed(cell_mm=4))
    refuses("field", plan, "--field", other, words=["other.json", "not the field of the plan"])
    empty = json.loads(plan.read_text())
    empty["paths"] = []
    other.write_text(json.dumps(empty))
    refuses("field", other, words=["no path"])
    for loop, words in [(0.5, "1 to 1000"), (2000, "0 to 1000"), ("20", "number")]:
        other.write_text(json.dumps({**json.loads(plan.read_text()), "loop_ms": loop}))
        refuses("field", other, words=["other.json", "loop_ms", str(loop), words])
    near = json.loads(plan.read_text())
    near["plane"]["origin_mm"] = [0, 0, 1]
    other.write_text(json.dumps(near))
    refuses("field", other, words=["on transducer"])
