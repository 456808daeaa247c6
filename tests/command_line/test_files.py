"""Conflicts between the files of a command: no output may be an input or another output, as checked before any work."""

import itertools
import json
import os
import re
import subprocess

import numpy as np
import pytest

from test_bad_input import foci_file, hand_lines

COMMANDS = ["run", "plan", "capture", "bench", "field", "solve", "devices", "check", "settings",
            "selftest", "soak"]
# text options that are not files; any other text option must state whether it is INPUT or OUTPUT
WORDS = {"NAME", "ADDRESS"}


def options_of(program, command):
    """Returns the options and positional arguments of a command, with the metavars in its help."""
    text = subprocess.run([str(program), command, "--help"], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^  (--[a-z-]+|[a-z]+) ([A-Z|]+)\b", text, re.MULTILINE)
    assert found, text
    return dict(found)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_text_option_states_whether_it_is_a_file(program, command):
    kinds = set(options_of(program, command).values())
    assert kinds <= WORDS | {"INPUT", "NAME|INPUT", "OUTPUT", "INT", "FLOAT", "UINT"}, kinds


@pytest.mark.parametrize("command", COMMANDS)
def test_no_output_may_be_another_file_of_the_command(program, refuses, tmp_path, command):
    options = options_of(program, command)
    outputs = [name for name, kind in options.items() if kind == "OUTPUT"]
    files = [name for name, kind in options.items() if kind in ("OUTPUT", "INPUT", "NAME|INPUT")]
    assert "--json" in outputs
    (tmp_path / "inner").mkdir()
    for output, other in itertools.product(outputs, files):
        if output == other or {output, other} == {"--tracker-file", "--tracker"}:
            continue
        both_outputs = other in outputs
        path = tmp_path / f"{output.strip('-')}-{other.strip('-')}.json"
        if not both_outputs:
            path.write_text("{}")
        arguments = [command]
        # required arguments other than the one under test
        for name in ("field", "plan", "foci", "files"):
            if name in options and name != other:
                (tmp_path / "given.json").write_text("{}")
                arguments.append(tmp_path / "given.json")
        if command == "capture" and "--out" not in (output, other):
            arguments += ["--out", "o.h5"]
        if command in ("run", "soak"):
            arguments += ["--view"]
        if other == "--beside" and output != "--figure":
            arguments += ["--figure", "f.png"]
        arguments += [path] if not other.startswith("--") else [other, path]
        arguments += [output, f"inner/../{path.name}"]
        refuses(*arguments, words=["one file", path.name])
        assert path.exists() != both_outputs and (both_outputs or path.read_text() == "{}")


def field_npy(tmp_path, name="field.npy"):
    np.save(tmp_path / name, np.ones((4, 5)))
    return tmp_path / name


def test_links_and_other_names_refer_to_the_same_file(refuses, tmp_path):
    field = field_npy(tmp_path)
    before = field.read_bytes()
    (tmp_path / "soft.json").symlink_to(field)
    os.link(field, tmp_path / "hard.json")
    (tmp_path / "here").symlink_to(tmp_path, target_is_directory=True)
    for name in ("field.npy", "./field.npy", "here/field.npy", "soft.json", "hard.json", "here/soft.json"):
        refuses("plan", field, "--cell-mm", "5", "--json", name, words=["one file", "--json"])
        assert field.read_bytes() == before
    # two outputs that do not exist yet
    (tmp_path / "later.svg").symlink_to("a.svg")
    for name in ("a.svg", "here/a.svg", "later.svg"):
        refuses("plan", field, "--cell-mm", "5", "--json", "a.svg", "--figure", name, words=["one file"])
    assert not (tmp_path / "a.svg").exists()


def test_a_file_named_in_the_settings_is_an_input_too(prostm, refuses, tmp_path):
    field, array, settings = field_npy(tmp_path), tmp_path / "array.json", tmp_path / "s.toml"
    array.write_text('{"format": "prostm-array/1", "name": "one", "frequency_hz": 40000, "radius_mm": 4.5,'
                     ' "directivity": "omni", "amplitude_pa_m": 3, "transducers_mm": [[0, 0, 0]]}')
    settings.write_text('[pipeline]\narray = "array.json"\n')
    common = ["plan", field, "--cell-mm", "5", "--settings", settings, "--json"]
    refuses(*common, "./array.json", words=["one file", "array.json", "s.toml"])
    prostm(*common, "plan.json")


def test_distinct_outputs_do_not_conflict(prostm, tmp_path):
    field = field_npy(tmp_path)
    for _ in range(2):  # both exist the second time
        prostm("plan", field, "--cell-mm", "5", "--json", "a.json", "--figure", "a.svg")
    prostm("plan", field, "--cell-mm", "5", "--json", "/dev/null")


def test_a_tracker_file_may_be_calibrated_again(refuses, tmp_path):
    pose = tmp_path / "pose.json"
    pose.write_text(json.dumps({"format": "prostm-pose/1", "position_mm": [0, 121, 0], "quaternion": [0, 0, 0, 1]}))
    run = ["run", "--view", "--hand", "leap://127.0.0.1:6437"]
    arguments = [*run, "--tracker", pose, "--tracker-file", "./pose.json", "--seconds"]
    refuses(*arguments, "-1", words=["--seconds"])  # not about the files
    (tmp_path / "s.toml").write_text('[pipeline]\ntracker = "pose.json"\n')
    refuses(*run, "--settings", "s.toml", "--tracker-file", "pose.json", "--seconds", "-1", words=["--seconds"])
    refuses("run", "--view", "--json", "prostm-tracker.json", words=["one file", "--tracker-file"])
    refuses("run", "--view", "--tracker-file", "gone/pose.json", words=["gone/pose.json"])


def test_protected_files_are_kept(refuses, tmp_path):
    field = field_npy(tmp_path)
    for arguments, name in ((["plan", field, "--cell-mm", "5", "--json"], "a.json"),
                            (["plan", field, "--cell-mm", "5", "--figure"], "a.svg"),
                            (["run", "--grid", "32", "--record"], "a.h5"),
                            (["capture", "--grid", "32", "--out"], "b.h5")):
        kept = tmp_path / name
        kept.write_text("old")
        kept.chmod(0o444)
        refuses(*arguments, name, words=[name, "protected (mode 444)"])
        assert kept.read_text() == "old"


def test_outputs_are_checked_before_the_inputs_are_read(refuses, tmp_path):
    """All inputs are invalid: a command that reads one first never reaches the output."""
    for name in ("bad.json", "bad.h5", "bad.jsonl", "bad.toml"):
        (tmp_path / name).write_text("nonsense")
    for arguments in (["run", "--settings", "bad.toml"], ["run", "--hand", "bad.jsonl"], ["plan", "bad.json"],
                      ["capture", "--out", "o.h5", "--hand", "bad.jsonl"], ["bench", "bad.h5"],
                      ["field", "bad.json"], ["solve", "bad.json"], ["devices"]):
        refuses(*arguments, "--json", "gone/out.json", words=["gone/out.json", "folder"])
    refuses("capture", "--hand", "bad.jsonl", "--out", "gone/o.h5", words=["gone/o.h5"])
    refuses("run", "--hand", "bad.jsonl", "--record", "gone/o.h5", words=["gone/o.h5"])
    refuses("plan", "bad.json", "--figure", "gone/f.svg", words=["gone/f.svg"])


def test_a_pipe_without_a_writer_is_rejected(refuses, tmp_path):
    for name in ("p.json", "p.npy", "p.h5", "p.jsonl"):
        os.mkfifo(tmp_path / name)
    field = field_npy(tmp_path)
    for arguments in (["plan", "p.json"], ["plan", "p.npy", "--cell-mm", "5"], ["plan", "p.h5"], ["bench", "p.h5"],
                      ["run", "--hand", "p.jsonl"], ["run", "--settings", "p.json"], ["run", "--tracker", "p.json"],
                      ["run", "--array", "p.json"], ["field", "p.json"], ["solve", "p.json"],
                      ["plan", field, "--cell-mm", "5", "--beside", "p.json", "--figure", "f.svg"]):
        refuses(*arguments, words=["p.", "ordinary file"])


@pytest.mark.long
def test_a_hand_renamed_in_every_frame_is_one_hand(prostm, refuses, tmp_path):
    header, frames = hand_lines()

    def run(*ids, step=0.01):
        lines = [header] + [{"t": step * i, "hands": [dict(frames[0]["hands"][0], id=n)]} for i, n in enumerate(ids)]
        (tmp_path / "a.hands.jsonl").write_text("\n".join(map(json.dumps, lines)) + "\n")
        return ["run", "--grid", "32", "--stepped", "--seconds", "2", "--hand", "a.hands.jsonl", "--json", "-"]

    named, renamed = (json.loads(prostm(*run(*ids)).stdout)["plans"] for ids in ([7] * 99, range(99)))
    assert renamed == named > 10
    refuses(*run(*range(9), step=0.1), words=["max_gap = 0.06 s"])


def test_foci_reject_unknown_values(refuses, tmp_path):
    path = foci_file(tmp_path, [0, 0, 200])
    foci = json.loads(path.read_text())
    foci["foci"][0]["presure_pa"] = 3
    path.write_text(json.dumps(foci))
    refuses("solve", path, words=["presure_pa", "did you mean", "pressure_pa"])
