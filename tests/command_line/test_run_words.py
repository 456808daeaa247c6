"""Messages of a run: the verdict first, the location of its files, the state of its tracker; and of prostm check."""

import base64
import hashlib
import json
import os
import pty
import re
import signal
import socket
import subprocess
import threading
import time

import pytest

from conftest import ROOT, free_port
from waiting import wait_for

SMALL = ["run", "--grid", "32"]


def start(program, folder, *arguments, **options):
    return subprocess.Popen([str(program), *map(str, arguments)], cwd=folder, text=True, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


@pytest.mark.long
def test_the_verdict_precedes_the_numbers(prostm, tmp_path):
    done = prostm(*SMALL, "--stepped", "--seconds", "4", "--json", "run.json")
    lines = done.stdout.splitlines()
    verdict = json.loads((tmp_path / "run.json").read_text())["verdict"]
    assert verdict["held"] is None and 1 <= len(verdict["sentences"]) <= 4
    assert lines[:len(verdict["sentences"]) + 1] == [*verdict["sentences"], ""]
    assert re.match(r"4\.0 s of the scene were computed in \d+\.\d s, (as fast as|\d+\.\d times (faster|slower) than) real time; ", lines[0])
    for heading in ["The run: one-plume, 4.0 s", "Latency, from ", "Computing time "]:
        assert any(line.startswith(heading) for line in lines)


@pytest.mark.long
def test_no_number_is_minus_zero(prostm):
    done = prostm(*SMALL, "--stepped", "--seconds", "4")
    assert "\n    lap " in done.stdout and "\n    contact " not in done.stdout, "only parts that take time are listed"
    assert not re.search(r"-0\.0*\s", done.stdout)
    assert not re.search(r"-0\.0*\s", prostm("plan", ROOT / "data/palm.npy", "--cell-mm", "5").stdout)


def test_in_real_time_the_verdict_is_about_the_rates(prostm, tmp_path):
    prostm(*SMALL, "--seconds", "2", "--json", "run.json")
    summary = json.loads((tmp_path / "run.json").read_text())
    share = summary["world_steps"] / (summary["world_steps"] + summary["skipped_world_steps"])
    assert summary["mode"] == "realtime" and summary["took_seconds"] == pytest.approx(2.0, abs=0.5)
    assert isinstance(summary["verdict"]["held"], bool)
    if share < 0.99:
        assert summary["verdict"]["held"] is False
    assert "of 50 Hz, plans" in summary["verdict"]["sentences"][0]


@pytest.mark.long
def test_every_file_is_named_once_and_standard_output_is_not(prostm, tmp_path):
    done = prostm(*SMALL, "--stepped", "--seconds", "6", "--record", "r.h5", "--figure", "r.png", "--json", "r.json")
    assert re.findall(r"^wrote (.*)$", done.stdout, re.M) == ["r.h5", "r.json", "r.png"]
    done = prostm(*SMALL, "--stepped", "--seconds", "1", "--record", "s.h5", "--json", "-")
    json.loads(done.stdout)
    assert re.findall(r"^wrote (.*)$", done.stderr, re.M) == ["s.h5"]
    done = prostm("capture", "--grid", "32", "--frames", "2", "--out", "c.h5", "--json", "c.json")
    assert re.findall(r"^wrote (.*)$", done.stdout, re.M) == ["c.h5", "c.json"]
    assert all((tmp_path / name).exists() for name in ["r.h5", "r.json", "r.png", "s.h5", "c.h5", "c.json"])


def test_an_interrupted_run_names_its_files(program, tmp_path):
    running = start(program, tmp_path, *SMALL, "--seconds", "600", "--record", "r.h5", "--json", "r.json")
    wait_for((tmp_path / "r.h5.part.h5").exists)
    time.sleep(1.0)
    running.send_signal(signal.SIGINT)
    out, _ = running.communicate(timeout=60)
    assert running.returncode == 130
    assert out.splitlines()[-2:] == ["wrote r.h5", "wrote r.json"] and "cut short" in out


def test_a_run_that_stayed_open_names_its_files_at_the_end(program, tmp_path):
    running = start(program, tmp_path, *SMALL, "--seconds", "1", "--view", "--view-port", "0", "--stay", "--json", "r.json")
    wait_for((tmp_path / "r.json").exists)
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    out, _ = running.communicate(timeout=60)
    assert running.returncode == 0
    assert out.splitlines()[-1] == "wrote r.json" and out.count("wrote r.json") == 2


def on_a_terminal(program, folder, *arguments, kind="xterm"):
    """Returns what a terminal receives from a command, including escape sequences."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen([str(program), *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=theirs, stderr=theirs,
                               env={**os.environ, "TERM": kind})
    os.close(theirs)
    shown = b""
    try:
        while part := os.read(ours, 65536):
            shown += part
    except OSError:  # the other end is closed
        pass
    assert process.wait(timeout=60) == 0
    os.close(ours)
    return shown.decode()


@pytest.mark.long
@pytest.mark.parametrize("arguments, first_word", [
    ([*SMALL, "--as-fast-as-possible", "--seconds", "3"], "3.0 s of the scene"),
    (["capture", "--grid", "32", "--frames", "20", "--out", "c.h5"], "recorded 20 fields"),
])
def test_the_progress_line_is_erased_before_other_output(program, tmp_path, arguments, first_word):
    shown = on_a_terminal(program, tmp_path, *arguments)
    line = next(line for line in shown.split("\n") if first_word in line)
    assert "\r\x1b[K" in line, "no progress was shown"
    assert line.split("\r\x1b[K")[-1].startswith(first_word)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["dumb", ""])
def test_a_terminal_without_erase_gets_no_escape_sequences(program, tmp_path, kind):
    shown = on_a_terminal(program, tmp_path, *SMALL, "--as-fast-as-possible", "--seconds", "3", kind=kind)
    assert "3.0 s of the scene" in shown and "\x1b" not in shown and "running" not in shown


@pytest.mark.long
def test_the_summary_starts_with_a_held_hand_without_its_stimulus(prostm, tmp_path):
    def first(grid):
        out = prostm("run", "--scene", "four-plumes", "--hand", "study", "--grid", str(grid), "--seconds", "8",
                     "--as-fast-as-possible", "--json", "r.json").stdout
        return out.splitlines()[0], json.loads((tmp_path / "r.json").read_text())

    line, summary = first(32)
    assert line.startswith("The held hand did not get the stimulus of four-plumes: 0 % of its updates passed the gate")
    assert "--grid 32 is too coarse for this scene: use --grid 56." in line
    assert summary["verdict"]["sentences"][0] == line and summary["held_updates"] > 60
    # its advice helps
    line, summary = first(56)
    assert line.startswith("8.0 s of the scene")
    assert summary["held_passed_updates"] >= 0.8 * summary["held_updates"]


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no affinity of processes on this system")
def test_check_counts_the_cores_available_to_it(program, tmp_path):
    one = min(os.sched_getaffinity(0))
    running = subprocess.Popen([str(program), "check"], cwd=tmp_path, stdout=subprocess.PIPE, text=True,
                               preexec_fn=lambda: os.sched_setaffinity(0, {one}))
    assert running.stdout.readline().startswith("1 core of ")
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=60)


def test_a_missing_tracker_is_reported_at_once_and_in_the_exit_status(program, tmp_path):
    port = free_port()
    running = start(program, tmp_path, *SMALL, "--hand", f"leap://127.0.0.1:{port}", "--seconds", "4", "--json", "r.json",
                    "--record", "r.h5", "--figure", "r.png")
    line = running.stdout.readline()
    reported = time.monotonic()
    for words in [f"No tracker yet: nothing answers at leap://127.0.0.1:{port}; ", "UltraleapTrackingWebSocket", "6437",
                  "keeps trying"]:
        assert words in line
    out, errors = running.communicate(timeout=60)
    assert time.monotonic() - reported > 1.0, "long before the end"
    assert running.returncode == 3 and errors == ""
    assert out.count("No tracker yet") == 0 and "No hand frame ever arrived: " in out
    summary = json.loads((tmp_path / "r.json").read_text())
    assert summary["tracker"]["frames"] == 0 and summary["seconds"] == pytest.approx(4.0, abs=0.1)
    assert (tmp_path / "r.h5").exists() and "no picture was drawn in r.png" in out


def test_a_missing_openxr_runtime_is_reported_likewise(prostm, monkeypatch, tmp_path):
    monkeypatch.setenv("XR_RUNTIME_JSON", str(tmp_path / "none.json"))
    out = prostm(*SMALL, "--hand", "openxr", "--seconds", "2", status=3).stdout
    assert out.startswith("No tracker yet: there is no OpenXR runtime here; install one")
    assert "XR_RUNTIME_JSON" in out.splitlines()[0]


class LeapStandIn:
    """A service that accepts one connection after another and sends frames without hands until it is closed."""

    def __init__(self, port):
        self.listener = socket.create_server(("127.0.0.1", port))
        self.sockets, self.over = [], False
        self.thread = threading.Thread(target=self.serve)
        self.thread.start()

    def serve(self):
        while not self.over:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return
            self.sockets.append(client)
            try:
                self.talk(client)
            except OSError:
                pass

    def talk(self, client):
        asked = client.recv(4096).decode()
        key = re.search(r"Sec-WebSocket-Key: (\S+)", asked).group(1)
        accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
        client.sendall(f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode())
        stamp = 0
        while not self.over:
            stamp += 10_000
            text = json.dumps({"id": stamp, "timestamp": stamp, "hands": [], "pointables": []}).encode()
            client.sendall(bytes([0x81, len(text)]) + text)
            time.sleep(0.01)

    def close(self):
        self.over = True
        for one in [self.listener, *self.sockets]:
            try:
                one.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
            one.close()
        self.thread.join()


def news(running):
    """Returns the next line, without those on the rates, which depend on what else the machine does."""
    while (line := running.stdout.readline()).startswith("The rates "):
        pass
    return line


def test_a_tracker_that_comes_and_goes_is_reported_once_each(program, tmp_path):
    port = free_port()
    running = start(program, tmp_path, *SMALL, "--hand", f"leap://127.0.0.1:{port}", "--seconds", "600", "--json", "r.json")
    try:
        assert news(running).startswith("No tracker yet: ")
        service = LeapStandIn(port)
        assert news(running).startswith("The tracker is there: connected to leap://")
        service.close()
        assert news(running).startswith("The tracker is lost: ")
        service = LeapStandIn(port)
        assert news(running).startswith("The tracker is back: ")
        service.close()
    finally:
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=60)
    assert running.returncode == 130
    sentences = json.loads((tmp_path / "r.json").read_text())["verdict"]["sentences"]
    assert any(sentence.startswith("The tracker was lost") for sentence in sentences), out


@pytest.mark.realtime
def test_check_reports_within_20_s_what_this_machine_can_run(program, tmp_path):
    begun = time.monotonic()
    running = start(program, tmp_path, "check", "--json", "check.json")
    out, errors = running.communicate(timeout=60)
    assert time.monotonic() - begun < 21.0 and errors == ""
    check = json.loads((tmp_path / "check.json").read_text())
    assert check["format"] == "prostm-check/1"
    assert running.returncode == (0 if check["defaults_hold"] else 1)
    trials = check["trials"]
    assert (trials[0]["grid"], trials[0]["preset"]) == (64, "best")
    assert [trial["held"] for trial in trials[:-1]] == [False] * (len(trials) - 1)
    last = trials[-1]
    assert set(check["scenes"]) == {"one-plume", "two-plumes", "three-plumes", "four-plumes"}
    for use in check["scenes"].values():
        assert use is None or (last["held"] and use["grid"] <= last["grid"] and use["preset"] == last["preset"])
    assert check["use"] in (None, check["scenes"]["four-plumes"])
    assert check["defaults_hold"] is trials[0]["held"]
    assert check["cores"] >= 1 and check["vectors"] and check["sleep_late_ms"]["n"] > 100
    for sentence in check["sentences"]:
        assert sentence in out.splitlines()
    assert out.splitlines()[-1] == "wrote check.json"


def test_check_ends_by_a_signal(program, tmp_path):
    running = start(program, tmp_path, "check", "--json", "check.json")
    assert " core" in running.stdout.readline()
    running.send_signal(signal.SIGINT)
    out, errors = running.communicate(timeout=20)
    assert running.returncode == 130 and errors == ""
    assert out.splitlines()[-1] == "Stopped before the answer was known."
    assert not (tmp_path / "check.json").exists()
