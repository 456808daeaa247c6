"""Early termination of commands, by signals and full disks: finished results are kept and reported."""

import json
import os
import resource
import signal
import subprocess
import time

import h5py
import pytest

from waiting import wait_for
from test_commands import blob_field


def start(program, folder, *arguments, limit=None):
    """Starts a recorded run of ten minutes; no file grows beyond `limit` [bytes]."""

    def prepare():
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        if limit is not None:  # emulates a full disk
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.Popen(
        [str(program), "run", "--grid", "32", "--seconds", "600", "--record", "run.h5", "--json", "run.json",
         "--figure", "run.png", *arguments],
        cwd=folder, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        preexec_fn=prepare, restore_signals=False)


# batch systems warn with USR1, USR2 or ALRM before they kill, and ulimit -t with XCPU
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGXCPU"])
def test_a_signal_ends_a_run_with_complete_files(program, tmp_path, name):
    running = start(program, tmp_path)
    part = tmp_path / "run.h5.part.h5"
    wait_for(part.exists)
    wait_for(lambda: part.stat().st_size > 100_000)  # without frames it has 40 kB
    running.send_signal(getattr(signal, name))
    out, errors = running.communicate(timeout=60)
    assert running.returncode == 128 + getattr(signal, name) and errors == ""
    line = next(line for line in out.splitlines() if line.startswith("The run: one-plume"))
    assert "cut short by" in line and name in line
    summary = json.loads((tmp_path / "run.json").read_text())
    assert name in summary["stopped_by"]
    assert summary["stopped"] is True and summary["failure"] is None and summary["seconds"] < 60
    with h5py.File(tmp_path / "run.h5") as h5:
        assert json.loads(h5.attrs["summary"])["world_steps"] == summary["world_steps"]
        assert len(h5["frame/time"]) > 0
    assert not part.exists()
    assert (tmp_path / "run.png").exists() or "no picture was drawn in run.png" in out


def test_a_second_signal_ends_at_once_with_the_shells_status(program, tmp_path):
    running = start(program, tmp_path, "--as-fast-as-possible")
    wait_for((tmp_path / "run.h5.part.h5").exists)
    running.send_signal(signal.SIGSTOP)
    running.send_signal(signal.SIGTERM)
    running.send_signal(signal.SIGHUP)
    running.send_signal(signal.SIGCONT)
    running.communicate(timeout=60)
    assert running.returncode in (128 + signal.SIGTERM, 128 + signal.SIGHUP)


@pytest.mark.parametrize("name", ["SIGHUP", "SIGUSR1"])
def test_an_ignored_signal_stays_ignored(program, tmp_path, name):
    number = getattr(signal, name)
    running = subprocess.Popen([str(program), "run", "--grid", "32", "--seconds", "2", "--json", "run.json"], cwd=tmp_path,
                               stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(number, signal.SIG_IGN))
    time.sleep(1.0)
    running.send_signal(number)
    assert running.wait(timeout=60) == 0
    summary = json.loads((tmp_path / "run.json").read_text())
    assert summary["stopped"] is False and summary["stopped_by"] is None


@pytest.mark.parametrize("pace", [pytest.param("--realtime", marks=pytest.mark.long),
                                  pytest.param("--as-fast-as-possible", marks=pytest.mark.long), "--stepped"])
def test_a_full_disk_ends_a_run(program, tmp_path, pace):
    running = start(program, tmp_path, pace, limit=1_000_000)
    out, errors = running.communicate(timeout=120)
    assert running.returncode == 2
    lines = errors.splitlines()
    assert len(lines) == 1 and lines[0].startswith("prostm: run.h5 cannot be written (File too large); ")
    assert "The run: one-plume" in out
    summary = json.loads((tmp_path / "run.json").read_text())
    assert summary["stopped"] is True and "prostm: " + summary["failure"] == lines[0]
    assert not (tmp_path / "run.h5").exists()
    assert "the recording up to then is in run.h5.part.h5" in lines[0]
    with h5py.File(tmp_path / "run.h5.part.h5") as h5:
        assert len(h5["frame/time"]) > 0


@pytest.mark.parametrize("arguments", [
    ["devices"],
    ["devices", "--json", "-"],
    ["--help"],
    ["run", "--help"],
    ["--version"],
    ["run", "--stepped", "--grid", "32", "--seconds", "0.1"],
    ["run", "--stepped", "--grid", "32", "--seconds", "0.1", "--json", "-"],
])
def test_a_full_standard_output_is_reported(program, tmp_path, arguments):
    with open("/dev/full", "w") as full:
        done = subprocess.run([str(program), *arguments], cwd=tmp_path, stdin=subprocess.DEVNULL, stdout=full,
                              stderr=subprocess.PIPE, text=True, timeout=60)
    assert done.returncode == 2
    told = [line for line in done.stderr.splitlines() if line.startswith("prostm: ")]
    assert len(told) == 1 and told[0].startswith("prostm: standard output cannot be written (")


@pytest.mark.parametrize("names", [["plan.json"], ["plan.svg", "plan.json"]])
def test_files_are_complete_if_the_reader_of_a_pipe_leaves(program, tmp_path, names):
    (tmp_path / "blob.json").write_text(json.dumps(blob_field()))
    reading, writing = os.pipe()
    os.close(reading)
    options = [word for name in names for word in (("--json" if name.endswith("json") else "--figure"), name)]
    done = subprocess.run([str(program), "plan", "blob.json", *options], cwd=tmp_path, stdout=writing,
                          stderr=subprocess.PIPE, text=True, timeout=60)
    os.close(writing)
    assert done.returncode == 2 and done.stderr == "prostm: standard output cannot be written (Broken pipe)\n"
    assert all((tmp_path / name).stat().st_size > 0 for name in names)


def test_files_are_complete_if_standard_output_is_full(program, tmp_path):
    with open("/dev/full", "w") as full:
        done = subprocess.run([str(program), "run", "--stepped", "--grid", "32", "--seconds", "1", "--json", "run.json",
                               "--record", "run.h5"], cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert done.returncode == 2
    assert json.loads((tmp_path / "run.json").read_text())["world_steps"] == 50
    with h5py.File(tmp_path / "run.h5") as h5:
        assert len(h5["frame/time"]) == 25
