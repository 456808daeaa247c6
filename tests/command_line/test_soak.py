"""prostm soak: every dip has a time, a name and a cause."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from waiting import wait_for


def soak(program, folder, *arguments, minutes="0.1"):
    return subprocess.Popen([str(program), "soak", "--minutes", minutes, "--grid", "32", "--json", "soak.json", *arguments],
                            cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def child_of(process):
    """Waits for the process that puts load on the cores."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    wait_for(lambda: children.read_text().split())
    return int(children.read_text())


def check(result):
    assert result["format"] == "prostm-soak/1"
    parts = result["parts"]
    dips = [0, 0, 0]
    covered = [0, 0, 0]
    for dip in result["dips"]:
        assert dip["cause"] and dip["what"] and dip["count"] > 0
        part = parts[dip["part"]]
        assert part["from_s"] <= dip["time_s"] <= part["to_s"] + 0.01
        (covered if dip["covered"] else dips)[dip["part"]] += dip["count"]
    assert dips == [part["dips"] for part in parts] and covered == [part["covered"] for part in parts]
    assert result["dips_left_out"] == 0


def test_a_soak_counts_like_its_run(program, tmp_path):
    process = soak(program, tmp_path)
    text, problem = process.communicate(timeout=120)
    result = json.loads((tmp_path / "soak.json").read_text())
    check(result)
    clean = all(part["dips"] == 0 for part in result["parts"])
    assert process.returncode == (0 if clean else 1) and problem == ""
    assert result["passed"] == clean and not result["stopped"]
    assert [part["loaded"] for part in result["parts"]] == [False, False, False]
    assert result["minutes"] == pytest.approx(0.1, abs=0.01)
    missed = sum(dip["count"] for dip in result["dips"] if dip["what"] == "missed blocks")
    # the device starts shortly before the first sample of the counters, and continues after the last one
    assert missed <= result["run"]["missed_blocks"]
    assert "first third, quiet" in text and "last third, quiet" in text and "wrote soak.json" in text


def test_the_load_uses_all_cores_for_a_third_and_ends(program, tmp_path):
    process = soak(program, tmp_path, "--load")
    child = child_of(process)
    used = lambda: sum(map(int, Path(f"/proc/{child}/stat").read_text().rsplit(")", 1)[1].split()[11:13]))  # noqa: E731
    time.sleep(1.5)
    before = used()
    # 2 to 4 s are loaded; other processes may leave it a small share of the cores
    wait_for(lambda: used() - before > 0.05 * os.sysconf("SC_CLK_TCK"))
    text, _ = process.communicate(timeout=120)
    result = json.loads((tmp_path / "soak.json").read_text())
    check(result)
    quiet = [part for part in result["parts"] if not part["loaded"]]
    assert len(quiet) == 2 and process.returncode == (0 if all(part["dips"] == 0 for part in quiet) else 1)
    assert all(dip["cause"] == "the load of this soak" for dip in result["dips"] if dip["part"] == 1)
    assert "second third, all cores loaded" in text
    assert not Path(f"/proc/{child}").exists()


def test_ctrl_c_leaves_a_complete_result(program, tmp_path):
    process = soak(program, tmp_path, "--load", minutes="30")
    time.sleep(2.5)
    process.send_signal(signal.SIGINT)
    text, _ = process.communicate(timeout=60)
    assert process.returncode == 130 and "Cut short" in text
    result = json.loads((tmp_path / "soak.json").read_text())
    check(result)
    assert result["stopped"] and not result["passed"] and 0 < result["minutes"] < 1


def test_the_load_ends_when_the_program_is_killed(program, tmp_path):
    process = soak(program, tmp_path, "--load", minutes="30")
    child = child_of(process)
    process.kill()
    process.wait(timeout=30)

    def gone():
        try:
            return Path(f"/proc/{child}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
        except FileNotFoundError:
            return True

    wait_for(gone)


@pytest.mark.parametrize("args, words", [
    (["--minutes", "0"], ["--minutes 0", "0.05 to 1440"]),
    (["--minutes", "nan"], ["--minutes nan"]),
    (["--device", "toaster"], ["toaster"]),
    (["--view", "--stay"], ["--stay", "prostm run"]),
    (["--hand", "page"], ["--hand page", "--view"]),
])
def test_bad_options(refuses, args, words):
    refuses("soak", *args, words=words)
