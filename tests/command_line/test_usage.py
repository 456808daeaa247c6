"""An invalid command line gets one sentence with the nearest name and the relevant help page."""

import json

import numpy as np
import pytest

from test_bad_input import changed, hand_lines


@pytest.mark.parametrize("arguments, sentence", [
    (["runn"], 'there is no command "runn"; did you mean "run"? See prostm --help'),
    (["runn", "--view"], 'there is no command "runn"; did you mean "run"? See prostm --help'),
    (["--figur", "a.png", "plan", "x.npy"], 'the program has no option "--figur"; see prostm --help'),
    (["dance"], 'there is no command "dance"; see prostm --help'),
    (["help", "plann"], 'there is no command "plann"; did you mean "plan"?'),
    (["plan", "x.npy", "--figur", "a.png"],
     'plan has no option "--figur"; did you mean "--figure"? See prostm plan --help'),
    (["plan", "--figur", "a.png", "x.npy"],
     'plan has no option "--figur"; did you mean "--figure"? See prostm plan --help'),
    (["plan", "x.npy", "--figur=a.png"],
     'plan has no option "--figur"; did you mean "--figure"? See prostm plan --help'),
    (["capture", "--ot", "x.h5"],
     'capture has no option "--ot"; did you mean "--out"? See prostm capture --help'),
    (["run", "--sec", "5"], 'run has no option "--sec"; did you mean "--seconds"? See prostm run --help'),
    (["run", "--wings"], 'run has no option "--wings"; see prostm run --help'),
    (["run", "view"], 'run does not expect "view"; did you mean "--view"? See prostm run --help'),
    (["levels", "autd3"], 'levels does not expect "autd3"; did you mean "--array autd3"? See prostm levels --help'),
    (["run", "four-plumes"],
     'run does not expect "four-plumes"; did you mean "--scene four-plumes"? See prostm run --help'),
    (["run", "smoke"], 'run does not expect "smoke"; did you mean "--world smoke"? See prostm run --help'),
    (["plan", "a.npy", "fast"], 'plan does not expect "fast"; did you mean "--preset fast"? See prostm plan --help'),
    (["plan", "a.npy", "best"], 'plan does not expect "best"; did you mean "--preset best"? See prostm plan --help'),
    (["levels", "or"], 'levels does not expect "or"; see prostm levels --help'),
    (["plan", "a.npy", "b.npy"], 'plan does not expect "b.npy"; see prostm plan --help'),
    (["plan"],
     "plan needs a file: target field (.json, .npy, .npz, .png or .h5, or - for standard input; docs/reference/files.md); "
     "see prostm plan --help"),
    (["bench"],
     "bench needs a file: recordings (.h5) of prostm capture or prostm run --record; see prostm bench --help"),
    (["plan", ""], "field needs the name of a file, and the one given is empty"),
    (["run", "--json", ""], "--json needs the name of a file, and the one given is empty"),
    (["capture"], "--out is missing: the recording (.h5); see prostm capture --help"),
    (["run", "--seconds"], "--seconds needs a value (FLOAT); see prostm run --help"),
    (["run", "--seconds", "ten"], '--seconds is "ten"; it must be a number; see prostm run --help'),
    (["run", "--paths", "2.5"], '--paths is "2.5"; it must be a whole number; see prostm run --help'),
    (["run", "--seed", "99999999999"],
     '--seed is "99999999999"; it must be a whole number within 32 bits; see prostm run --help'),
    (["run", "--seed", "1", "--seed", "2"], "--seed is given 2 times; give it once; see prostm run --help"),
    (["run", "--realtime", "--stepped"],
     "--realtime and --stepped exclude each other; leave one of them out; see prostm run --help"),
    (["run", "--figure-at", "3"], "--figure-at needs --figure; see prostm run --help"),
    (["plan", "x.npy", "--beside", "y.json"], "--beside needs --figure; see prostm plan --help"),
    (["field", "plan.json", "--invert"], "--invert needs --field; see prostm field --help"),
    (["run", "--stay"], "--stay needs --view; see prostm run --help"),
    (["run", "--view-port", "0"], "--view-port needs --view; see prostm run --help"),
    (["run", "--view-address", "127.0.0.1"], "--view-address needs --view; see prostm run --help"),
    (["run", "--view-host", "lab"], "--view-host needs --view; see prostm run --help"),
    (["run", "--tracker-file", "t.json"], "--tracker-file needs --view; see prostm run --help"),
    (["run", "--view", "--tracker-file", "t.json"],
     "--tracker-file is for the pose of a tracker, and --hand scripted has none; leave it out, or give --hand "
     "leap://HOST:PORT or openxr"),
    (["run", "--view", "--tracker-file", "t.txt"],
     "t.txt names no pose file; it must end in .json, as --tracker takes it"),
    (["run", "--json", "--view"], "--json needs the name of a file, and --view is an option"),
    (["run", "--preset", "bst"],
     '--preset "bst" is unknown: it must be paper, paper-valid, best, fast or felt; did you mean "best"?'),
    (["run", "--switch", "foo"], '--switch "foo" is unknown: it must be lap or now'),
    (["run", "--budget-ms", "-1"], "--budget-ms = -1 ms must be between 0 and 60000 ms"),
    (["plan", "foci.json", "--paths", "9"], "--paths = 9 must be between 1 and 8"),
    (["run", "--grid", "30"], "--grid = 30 must be between 32 and 160"),
    (["run", "--grid", "176"], "--grid = 176 must be between 32 and 160"),
    (["run", "--scene", "one-plum"], 'did you mean "one-plume"?'),
    (["run", "--world", "smok"], 'world "smok" is unknown: it must be smoke; did you mean "smoke"?'),
    (["run", "--array", "autd"], 'did you mean "autd3"?'),
    (["run", "--tracker", "center"], 'did you mean "centre"?'),
    (["run", "--hand", "scriptd"], 'scriptd cannot be read: there is no such file; did you mean "scripted"?'),
    (["run", "--hand", "leap"],
     'leap cannot be read: there is no such file; did you mean "leap://127.0.0.1:6437"?'),
    (["run", "--hand", "Leap"], 'did you mean "leap://127.0.0.1:6437"?'),
    (["capture", "--out", "x.h5", "--hand", "ultraleap"], 'did you mean "leap://127.0.0.1:6437"?'),
    (["run", "--hand", "leapmotion"], 'did you mean "leap://127.0.0.1:6437"?'),
    (["run", "--hand", "leap.json"], "leap.json cannot be read: there is no such file"),
    (["capture", "--hand", "leap://127.0.0.1:6437", "--out", "x.h5"],
     "capture does not run in real time, as --hand leap://127.0.0.1:6437 needs; record it with prostm run --hand "
     "leap://127.0.0.1:6437 --record x.h5"),
    (["capture", "--hand", "page", "--out", "x.h5"],
     "capture does not run in real time, as --hand page needs; record it with prostm run --view --hand page --record "
     "x.h5"),
    (["solve", "foci.json", "--solver", "gspat"], 'did you mean "gs-pat"?'),
    (["run", "--record", "x.txt"], "x.txt is not a name for a recording; it must end in .h5"),
    (["capture", "--out", "x.json"], "x.json is not a name for a recording; it must end in .h5"),
    (["run", "--figure", "x.json"], "x.json is not a known kind of figure; it must end in .png, .svg or .pdf"),
    (["run", "--json", "x.png"], "x.png would hold JSON, and .png is another kind of file; end its name in .json"),
    (["plan", "foci.json", "--json", "x.H5"],
     "x.H5 would hold JSON, and .h5 is another kind of file; end its name in .json"),
    (["plan", "foci.json"],
     'foci.json: "format" is "prostm-foci/1" (focal points, for prostm solve); it must be "prostm-field/1"'),
    (["run", "--hand", "foci.json"],
     "foci.json is a prostm-foci/1 file (focal points, for prostm solve), not a hand recording; a hand recording is "
     "hand-frames JSON Lines (.hands.jsonl) or a recording of a Leap (.json), see docs/guides/hands.md"),
])
def test_the_sentence(refuses, tmp_path, arguments, sentence):
    foci = {"format": "prostm-foci/1", "foci": [{"position_mm": [0, 0, 200], "pressure_pa": 100}]}
    (tmp_path / "foci.json").write_text(json.dumps(foci))
    told = refuses(*arguments)
    assert told == f"prostm: {sentence}" or (sentence.startswith("did") and told.endswith(sentence))
    assert [path.name for path in tmp_path.iterdir()] == ["foci.json"]


def test_help_in_every_way(program, prostm):
    whole, plan = prostm("--help").stdout, prostm("plan", "--help").stdout
    for command in ("run", "plan", "settings", "help"):
        assert f"\n  {command} " in whole
    assert "Example:" in plan and "--figure" in plan
    # the program's name is the path that it was called by, or its own name
    assert prostm("help").stdout.replace("prostm", str(program), 1) == whole.replace("prostm", str(program), 0) or \
        prostm("help").stdout.splitlines()[2:] == whole.splitlines()[2:]
    assert prostm("help", "plan").stdout.splitlines()[2:] == plan.splitlines()[2:]
    alone = prostm(status=2)
    assert alone.stdout == "" and alone.stderr == prostm("help").stdout


@pytest.mark.parametrize("name, what", [
    ("none.json", "none.json cannot be read: there is no such file"),
    ("gone/none.json", "gone/none.json cannot be read: there is no folder gone"),
    ("folder.json", "folder.json is a folder; name a file"),
])
def test_why_a_file_cannot_be_read(refuses, tmp_path, name, what):
    (tmp_path / "folder.json").mkdir()
    for arguments in (["plan", name], ["run", "--hand", name], ["field", name], ["run", "--settings", name]):
        assert refuses(*arguments) == f"prostm: {what}"


def test_a_file_of_the_wrong_kind_is_named(refuses, prostm, tmp_path):
    prostm("capture", "--grid", "32", "--frames", "1", "--out", "run.h5")
    np.save(tmp_path / "a.npy", np.ones((3, 3)))
    (tmp_path / "field.json").write_text(changed())
    (tmp_path / "text.txt").write_text("1 2 3\n")
    header, frames = hand_lines()
    (tmp_path / "me.hands.jsonl").write_text("\n".join(map(json.dumps, [header, *frames])))
    copies = {"h5.json": "run.h5", "npy.json": "a.npy", "json.npy": "field.json", "npy.png": "a.npy", "npy.h5": "a.npy"}
    for copy, original in copies.items():
        (tmp_path / copy).write_bytes((tmp_path / original).read_bytes())

    told = refuses("run", "--hand", "run.h5", words=["a recording of prostm (HDF5), not a hand recording"])
    assert "hand-frames JSON Lines (.hands.jsonl)" in told and "docs/guides/hands.md" in told
    refuses("run", "--hand", "text.txt", words=["is not a hand recording", ".hands.jsonl"])
    (tmp_path / "leap.json.lz").write_text("N4Ig")
    refuses("run", "--hand", "leap.json.lz", words=["compressed by lz-string", 'writeFileSync("leap.json"'])
    refuses("run", "--hand", "a.npy", words=["is an NPY file, not a hand recording"])
    refuses("plan", "h5.json", words=["is an HDF5 file, not JSON"])
    refuses("plan", "npy.json", words=["is an NPY file, not JSON"])
    refuses("plan", "json.npy", "--cell-mm", "5", words=["is JSON, not an NPY file"])
    refuses("plan", "npy.png", "--cell-mm", "5", words=["is an NPY file, not a PNG picture"])
    refuses("plan", "npy.h5", words=["is an NPY file, not an HDF5 file"])
    refuses("bench", "field.json", words=["is JSON, not an HDF5 file"])
    refuses("field", "a.npy", words=["is an NPY file, not JSON"])
    refuses("run", "--settings", "field.json", words=["is JSON, not TOML"])
    refuses("plan", "text.txt", words=[".json, .npy, .npz, .png or .h5"])
    refuses("plan", "me.hands.jsonl", words=[
        "me.hands.jsonl is a recording of hands, not a field; ", "prostm capture --hand me.hands.jsonl --out FILE.h5",
        "prostm run --hand me.hands.jsonl"])
    prostm("plan", "field.json", "--json", "plan.json")
    refuses("plan", "plan.json", words=['is "prostm-plan/1" (a plan, for prostm field); it must be "prostm-field/1"'])
