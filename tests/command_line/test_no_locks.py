"""A file system without locks, such as NFS without a lock daemon: every command works with one warning, and a
participant's file is still limited to one run at a time, on one machine and between machines."""

import json
import os
import signal
import subprocess

import numpy as np
import pytest

from waiting import wait_for
from conftest import SHORT
from test_study import STUDY

SOURCE = "#include <errno.h>\nint flock(int fd, int how) { (void)fd; (void)how; errno = %s; return -1; }\n"


@pytest.fixture(params=["ENOLCK", "EOPNOTSUPP"])
def without_locks(request, tmp_path, monkeypatch):
    """Makes flock() fail in every program that the test starts."""
    library = tmp_path / "no-locks.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, "-xc", "-"], input=SOURCE % request.param, text=True, check=True)
    monkeypatch.setenv("LD_PRELOAD", str(library))
    monkeypatch.setenv("ASAN_OPTIONS", os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0")


def warnings_of(result):
    return [line for line in result.stderr.splitlines() if "has no locks" in line]


@pytest.mark.long
def test_recordings_are_written_and_read_with_a_warning(prostm, tmp_path, without_locks):
    run = prostm("run", "--grid", "32", "--stepped", "--seconds", "2", "--record", "r.h5")
    assert len(warnings_of(run)) == 1 and (tmp_path / "r.h5").exists()
    plan = prostm("plan", "r.h5", "--frame", "45", "--preset", "fast", "--json", "plan.json")
    assert len(warnings_of(plan)) == 1
    field = prostm("field", "plan.json", "--field", "r.h5", "--frame", "45")
    assert len(warnings_of(field)) == 1
    bench = prostm("bench", "r.h5", "--repeats", "1", "--preset", "fast")
    assert len(warnings_of(bench)) == 1
    np.save(tmp_path / "a.npy", np.eye(9))
    assert prostm("plan", "a.npy", "--cell-mm", "5", "--figure", "a.svg").stderr == ""


@pytest.mark.long
def test_a_participants_file_is_limited_to_one_run_at_a_time(program, prostm, refuses, tmp_path, without_locks):
    (tmp_path / "short.toml").write_text(SHORT)
    file = tmp_path / "answers" / "participant-7.jsonl"
    lock = tmp_path / "answers" / "participant-7.jsonl.lock"

    def start(*options):
        return subprocess.Popen([str(program), *STUDY, "7", *options], cwd=tmp_path, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def lines():
        return file.read_text().count("\n") if file.exists() else 0

    process = start()
    wait_for(lambda: lines() >= 1)
    refuses(*STUDY, "7", "--resume", words=["is being written by another program", f"process {process.pid}"])
    process.send_signal(signal.SIGKILL)
    process.communicate()

    before = lines()  # a crash on this machine is detected
    process = start("--resume")
    wait_for(lambda: lines() > before)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert "was left by process" in said and "has no locks" in said
    assert not lock.exists()

    before = lines()  # a crash on another machine is not
    owner = {"host": "lab-2", "machine": "0", "boot": "1", "pids": "2", "pid": 3, "started": "4"}
    lock.write_text(json.dumps(owner) + "\n")
    refuses(*STUDY, "7", "--resume", words=["process 3 on lab-2", "give --take-over", str(lock.name)])
    assert lines() == before and lock.exists()
    process = start("--resume", "--take-over")
    wait_for(lambda: lines() > before)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert "because --take-over is given" in said
    assert not lock.exists()
