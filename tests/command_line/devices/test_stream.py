"""prostm run --device stream://…: both receivers of examples/stream/, over TCP and UDP, in separate processes."""

import importlib.util
import json
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import pytest

from conftest import ROOT, free_port
from waiting import wait_for

STEP = 8.0 / 40e3  # largest step of an active focal point between samples [m]
CHANGE = 1.0 / 40.0  # largest change of an intensity between samples
SILENT_AFTER = 0.025  # after the last message [s]: 20 ms without one, then a ramp of 5 ms

RECEIVERS = [(language, over) for language in ("c++", "python") for over in ("tcp", "udp")]


def start_sender(program, folder, port, seconds):
    return subprocess.Popen([str(program), "run", "--device", f"stream://127.0.0.1:{port}", "--seconds", str(seconds),
                             "--grid", "32"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)


def command(program, language):
    if language == "python":
        return [sys.executable, str(ROOT / "examples" / "stream" / "prostm_receiver.py")]
    receiver = program.parent / "prostm_receiver"
    if not receiver.is_file():
        pytest.skip(f"needs {receiver}: build the target prostm_receiver")
    return [str(receiver)]


class Listener:
    """A running receiver, and the files that it writes."""

    def __init__(self, program, folder, language, over, port, *more):
        self.received, self.played = folder / f"{language}-{over}.received", folder / f"{language}-{over}.played"
        self.process = subprocess.Popen(
            [*command(program, language), f"127.0.0.1:{port}", *(["--udp"] if over == "udp" else []), "--received",
             str(self.received), "--played", str(self.played), *more], stdout=subprocess.PIPE, text=True)

    def end(self):
        """Stops the receiver; returns its last statistics and all its output."""
        self.process.send_signal(signal.SIGTERM)
        out, _ = self.process.communicate(timeout=60)
        assert self.process.returncode == 0
        return json.loads(out.splitlines()[-1]), out


def row_type(foci):
    """Type of a row of a receiver's files: index or time of delivery [ns], time [ns], focal points, factor, and x, y, z
    [m] and the intensity of each focal point."""
    return np.dtype([("first", "<i8"), ("time", "<i8"), ("foci", "<i4"), ("gain", "<f4"), ("focus", "<f4", (foci, 4))])


def rows_of(path, foci=4):
    data = path.read_bytes()
    row = row_type(foci)
    rows = np.frombuffer(data[:len(data) // row.itemsize * row.itemsize], row)
    assert (rows["foci"] == foci).all()
    return rows


def newest_rows(path, count=40):
    """The last rows; all have four focal points."""
    size = row_type(4).itemsize
    whole = path.stat().st_size // size if path.exists() else 0
    if whole == 0:
        return rows_of_bytes(b"")
    with path.open("rb") as file:
        file.seek(max(0, whole - count) * size)
        return rows_of_bytes(file.read(min(count, whole) * size))


def rows_of_bytes(data):
    return np.frombuffer(data, row_type(4))


def check_emission(rows):
    """Checks that consecutive samples may follow each other in prostm's emission."""
    follows = np.diff(rows["first"]) == 1
    intensity = rows["focus"][:, :, 3]
    assert (0.0 <= intensity).all() and (intensity <= 1.0).all()
    assert (np.abs(np.diff(intensity, axis=0))[follows] <= CHANGE * 1.001).all()
    sounds = (intensity[:-1] > 0.01) & (intensity[1:] > 0.01) & follows[:, None]
    steps = np.linalg.norm(np.diff(rows["focus"][:, :, :3].astype(float), axis=0), axis=2)
    assert (steps[sounds] <= STEP + 1e-6).all()


def check_ramps(rows):
    """Checks that the factor changes by 1 in 5 ms, and drops at once only if the receiver itself was not scheduled."""
    change, time_step = np.diff(rows["gain"]), np.diff(rows["time"])
    assert (change <= 0.0051).all()
    assert ((change >= -0.0051) | ((rows["gain"][1:] == 0.0) & (time_step > 5_000_000))).all()


@pytest.mark.realtime
@pytest.mark.parametrize("language, over", RECEIVERS)
def test_the_emission_arrives(program, tmp_path, language, over):
    port = free_port()
    sender = start_sender(program, tmp_path, port, 3)
    listener = Listener(program, tmp_path, language, over, port)
    out, _ = sender.communicate(timeout=120)
    assert sender.returncode == 0, out
    time.sleep(0.2)
    statistics, printed = listener.end()
    rows = rows_of(listener.received)
    assert len(rows) > 40_000
    gaps = np.diff(rows["first"]) != 1
    assert not gaps.any() or statistics["lost"] + statistics["skipped"] > 0
    # play times jump only where prostm was late
    steps = np.diff(rows["time"])[~gaps]
    assert (steps > 0).all() and ((steps == 25_000).all() or "prostm was late" in printed)
    check_emission(rows)
    assert rows["focus"][:, :, 3].max() > 0.05
    assert statistics["malformed"] == 0 and statistics["subscriptions"] >= 1
    assert "end: prostm ends." in printed

    # uninterrupted output equals the input; at the end there is silence
    played = rows_of(listener.played)
    assert len(played) > 40_000
    whole = played[played["gain"] == 1.0]
    assert len(whole) > 1_000  # most samples, unless the machine is busy
    came = {focus.tobytes() for focus in rows["focus"]}
    assert all(focus.tobytes() in came for focus in whole["focus"])
    check_ramps(played)
    assert played[-1]["gain"] == 0.0
    print(f"{language} over {over}: {statistics}")


def wait_for_output(listener):
    """The hand is in the plume most of the time; waits until there is output."""

    def sounds():
        rows = newest_rows(listener.played)
        return (len(rows) > 0 and rows[-1]["time"] > time.monotonic_ns() - 50_000_000
                and (rows["gain"] == 1.0).all() and (rows["focus"][:, :, 3].max(axis=1) > 0.02).all())

    wait_for(sounds)


def silence_after(listener, begin, until):
    """Time from `begin` to the last non-zero sample before `until`, and to its delivery [s]; times in ns."""
    rows = rows_of(listener.played)
    sounding = rows[(rows["focus"][:, :, 3].max(axis=1) > 0.0) & (rows["time"] < until)]
    return [(int(sounding[name].max()) - begin) / 1e9 for name in ("time", "first")]


def check_silence(words, silent, handed):
    print(f"{words} to the last sounding sample {1e3 * silent:.1f} ms, to its handing over {1e3 * handed:.1f} ms")
    # a message may still have been in transit
    assert silent <= SILENT_AFTER + 0.005
    # a receiver that is not scheduled in the middle of its ramp finishes it up to 20 ms later
    assert handed <= SILENT_AFTER + 0.025


@pytest.mark.realtime
@pytest.mark.parametrize("language", ["c++", "python"])
def test_falls_silent_while_prostm_is_suspended(program, tmp_path, language):
    port = free_port()
    sender = start_sender(program, tmp_path, port, 600)
    listener = Listener(program, tmp_path, language, "tcp", port, "--every", "4")
    try:
        wait_for_output(listener)
        begin = time.monotonic_ns()
        sender.send_signal(signal.SIGSTOP)  # the connection stays open
        time.sleep(0.5)
        sender.send_signal(signal.SIGCONT)
        wait_for_output(listener)
        listener.end()
    finally:
        sender.kill()
        listener.process.kill()
        sender.communicate()
    check_silence(f"{language}: SIGSTOP", *silence_after(listener, begin, begin + 450_000_000))


@pytest.mark.realtime
@pytest.mark.parametrize("language, over", RECEIVERS)
def test_falls_silent_after_kill_9_and_resumes(program, tmp_path, language, over):
    port = free_port()
    sender = start_sender(program, tmp_path, port, 600)
    listener = Listener(program, tmp_path, language, over, port, "--every", "4")
    try:
        wait_for_output(listener)
        killed = time.monotonic_ns()
        sender.send_signal(signal.SIGKILL)
        sender.wait()
        time.sleep(0.5)
        again = start_sender(program, tmp_path, port, 600)
        try:
            wait_for_output(listener)
        finally:
            again.kill()
            again.communicate()
        statistics, printed = listener.end()
    finally:
        sender.kill()
        listener.process.kill()
        sender.communicate()
    check_silence(f"{language} over {over}: kill -9", *silence_after(listener, killed, killed + 450_000_000))
    assert statistics["subscriptions"] >= 2 and statistics["malformed"] == 0
    assert "silent " in printed


def python_receiver():
    spec = importlib.util.spec_from_file_location("prostm_receiver", ROOT / "examples" / "stream" / "prostm_receiver.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table_bytes(heading):
    """The number of bytes in a table of docs/devices/stream.md, from its last row's offset and type."""
    text = (ROOT / "docs" / "devices" / "stream.md").read_text(encoding="utf-8")
    table = text[text.index(heading):].split("\n\n")[0]
    last = [cell.strip() for cell in table.splitlines()[-1].strip("|").split("|")]
    sizes = {"u8": 1, "u16": 2, "u32": 4, "i64": 8, "f64": 8}
    size = sizes.get(last[1]) or int(last[1].split()[0] if last[1] else 0)
    return int(last[0]) + size


@pytest.mark.parametrize("heading, layout", [
    ("| at | type | header |", "HEADER"),
    ("| at | type | body, 72 bytes |\n|---|---|---|\n| 0 | u32 | token: over TCP", "SUBSCRIBE_BODY"),
    ("| at | type | body, 72 bytes |\n|---|---|---|\n| 0 | u32 | token for", "HELLO_BODY"),
    ("| at | type | body, 24 bytes |\n|---|---|---|\n| 0 | i64 | time |", "HEARTBEAT_BODY"),
    ("| at | type | body of TIME, 24 bytes |", "TIME_BODY"),
])
def test_the_document_and_the_receiver_agree_on_sizes(heading, layout):
    assert table_bytes(heading) == getattr(python_receiver(), layout).size


@pytest.mark.parametrize("address, words", [
    ("stream://127.0.0.1", ["already in use"]),
    ("stream://nowhere.example:7140", ["must be a number"]),
    ("stream://127.0.0.1:0", ["1 to 65535"]),
])
def test_bad_addresses_are_rejected_in_a_sentence(refuses, address, words):
    if address == "stream://127.0.0.1":
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            refuses("run", "--seconds", "1", "--device", f"{address}:{taken.getsockname()[1]}", words=["in use"])
        return
    refuses("run", "--seconds", "1", "--device", address, words=words)


def test_devices_lists_the_stream(prostm):
    rows = json.loads(prostm("devices", "--json", "-").stdout)
    assert "40000 Hz" in [row["detail"] for row in rows if row["kind"] == "stream"][0]


def test_the_receivers_explain_a_wrong_option(program):
    for language in ("c++", "python"):
        result = subprocess.run([*command(program, language), "--every", "0"], capture_output=True, text=True,
                                timeout=60)
        assert result.returncode == 2 and "1 to 1000" in result.stderr
