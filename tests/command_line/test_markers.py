"""Markers of prostm study run, over UDP and to a serial port: they match the order of the stimuli and the participant's
file."""

import json
import os
import pty
import re
import select
import socket
import termios
import threading
import tty

import pytest

from conftest import SHORT
from test_study import STUDY

LONG = SHORT.replace("repeats = 1", "repeats = 2")


class Receiver(threading.Thread):
    """Collects the datagrams that arrive at a port of 127.0.0.1."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.address = f"udp://127.0.0.1:{self.socket.getsockname()[1]}"
        self.lines = []
        self.start()

    def run(self):
        while True:
            text = self.socket.recv(65536).decode()
            if not text:
                return
            assert text.endswith("\n") and text.count("\n") == 1
            self.lines.append(json.loads(text))

    def stop(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
            own.sendto(b"", self.socket.getsockname())
        self.join()
        self.socket.close()
        return self.lines


@pytest.fixture
def rehearse(prostm, tmp_path):
    """Returns a function that rehearses trials of short.toml and returns the lines of the file and the output. If the
    machine does not keep up, the run is repeated with the next participant, at most three times. `options` is called
    for each run."""

    def run(trials, options=lambda: []):
        for participant in range(1, 4):
            said = prostm(*STUDY, participant, "--rehearse", trials, *options()).stdout
            if "did not keep up" not in said:
                return lines_of(tmp_path / "answers" / f"rehearsal-{participant}.jsonl"), said
        pytest.skip("the machine is too busy to keep up with a run in real time")

    return run


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def check_against_file(received, file):
    """Compares datagrams with the lines of a participant's file, and both with its trials."""
    written = [line for line in file if line["kind"] == "marker"]
    assert len(written) == len(received) > 0
    for got, line in zip(received, written):
        assert got.pop("type") == "marker"
        assert got.pop("participant") == file[0]["participant"]
        assert {key: line[key] for key in got} == got
        assert "failed" not in line
    assert [line["sequence"] for line in written] == list(range(1, len(written) + 1))
    for on, off in zip(written[::2], written[1::2]):
        assert (on["event"].split("-")[1], off["event"].split("-")[1]) == ("on", "off")
        assert (on["trial"], on["presentation"], on["stream"]) == (off["trial"], off["presentation"], off["stream"])
        assert 0 <= on["sample"] < off["sample"]
        seconds = (off["sample"] - on["sample"]) / on["rate_hz"]
        assert off["played_s"] - on["played_s"] == pytest.approx(seconds, abs=0.02)  # late blocks shift a stream
    for line in written:
        assert line["played_utc_s"] - line["played_s"] == pytest.approx(
            written[0]["played_utc_s"] - written[0]["played_s"], abs=0.05)
        assert line["late_ms"] == pytest.approx(1e3 * (line["sent_s"] - line["played_s"]), abs=0.01)
        assert line["late_ms"] > -0.01
    places = [(line["stream"], line["sample"]) for line in written]
    assert places == sorted(places)
    for trial in (line for line in file if line["kind"] == "trial"):
        on, off = [line for line in written if line["trial"] == trial["trial"]]
        begun = trial["time_s"] - trial["response_s"]  # the mute was lifted
        assert begun - 0.002 < on["played_s"] < trial["time_s"] < off["played_s"] < trial["time_s"] + 0.2
    return written


@pytest.mark.realtime
def test_markers_over_udp_match_the_file(prostm, rehearse, tmp_path):
    (tmp_path / "short.toml").write_text(LONG.replace("seconds = 0", "seconds = 1"))
    receivers = []

    def options():
        receivers[:] = Receiver(), Receiver()
        return [word for receiver in receivers for word in ("--markers", receiver.address)]

    file, said = rehearse(2, options)
    assert re.search(r"Markers were sent \d+\.\d\d ms .* after 3 beginnings, .* after 3 ends\.", said)
    one, other = (receiver.stop() for receiver in receivers)
    assert one == other
    assert not any("method" in line or "scene" in line for line in one)
    written = check_against_file(one, file)
    assert [line["event"] for line in written] == ["training-on", "training-off"] + 2 * ["stimulus-on", "stimulus-off"]
    assert [line["code"] for line in written] == [4, 5, 1, 2, 1, 2]
    assert {line["run"] for line in written} == {1}
    # a resumed participant has another run
    again = Receiver()
    prostm(*STUDY, file[0]["participant"], "--rehearse", "1", "--resume", "--markers", again.address)
    assert {line["run"] for line in again.stop()} <= {2}


@pytest.mark.realtime
def test_conditions_are_sent_if_the_protocol_allows_it(rehearse, tmp_path):
    (tmp_path / "short.toml").write_text(LONG + "[markers]\nconditions = true\n")
    receivers = []

    def options():
        receivers.append(Receiver())
        return ["--markers", receivers[-1].address]

    file, _ = rehearse(2, options)
    written = check_against_file(receivers[-1].stop(), file)
    trials = {line["trial"]: line for line in file if line["kind"] == "trial"}
    for line in written:
        assert (line["method"], line["scene"]) == ("am", trials[line["trial"]]["scene"])
        # a presentation's newest plan, and means over the trial: the modulation has one period throughout
        assert line["played"] == trials[line["trial"]]["played"]
        assert line["played"]["period_ms"] == pytest.approx(5.0, abs=0.1)
        place = ["one-plume", "four-plumes"].index(line["scene"])
        assert line["code"] == (16 + place if line["event"] == "stimulus-on" else 2)


@pytest.mark.realtime
def test_a_serial_port_gets_a_code_for_each_marker(rehearse, tmp_path):
    (tmp_path / "short.toml").write_text(LONG)
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    file, _ = rehearse(2, lambda: ["--markers", f"serial://{os.ttyname(theirs)}:9600"])
    assert select.select([ours], [], [], 5)[0]
    codes = list(os.read(ours, 100))[-4:]  # of the run under test
    assert codes == [line["code"] for line in file if line["kind"] == "marker"] == [1, 2, 1, 2]
    assert termios.tcgetattr(theirs)[5] == termios.B9600
    os.close(ours)
    os.close(theirs)


@pytest.mark.realtime
def test_without_targets_the_file_has_the_markers(rehearse, tmp_path):
    (tmp_path / "short.toml").write_text(LONG)
    file, said = rehearse(1)
    assert [line["event"] for line in file if line["kind"] == "marker"] == ["stimulus-on", "stimulus-off"]
    assert "Markers were sent" not in said


@pytest.mark.realtime
def test_a_study_continues_without_a_receiver(rehearse, tmp_path):
    (tmp_path / "short.toml").write_text(LONG)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as gone:
        gone.bind(("127.0.0.1", 0))
        address = f"udp://127.0.0.1:{gone.getsockname()[1]}"
    receivers = []

    def options():
        receivers.append(Receiver())
        return ["--markers", address, "--markers", receivers[-1].address]

    file, said = rehearse(2, options)
    assert said.count(f"Markers do not reach {address}: nothing is listening there. The study continues") == 1
    assert "2 of 4 answers" in said
    written = [line for line in file if line["kind"] == "marker"]
    assert len(receivers[-1].stop()) == len(written) == 4
    assert all(line["failed"] == [address] for line in written)


@pytest.mark.parametrize("address, words", [
    ("com1", ["--markers com1 must be udp://HOST:PORT or serial://PATH"]),
    ("udp://127.0.0.1:70000", ["port that is not a number from 1 to 65535"]),
    ("udp://no-such-host.invalid:9000", ["--markers udp://no-such-host.invalid:9000 cannot be opened"]),
    ("serial:///dev/none", ["--markers serial:///dev/none cannot be opened", "No such file"]),
    ("serial:///dev/null", ["it is not a serial port"]),
    ("serial:///dev/ttyUSB0:fast", ["rate that is not a number"]),
])
def test_a_target_that_cannot_be_opened_is_rejected(refuses, tmp_path, address, words):
    (tmp_path / "short.toml").write_text(SHORT)
    refuses(*STUDY, "1", "--markers", address, words=words)
    refuses(*STUDY, "1", *["--markers", "udp://127.0.0.1:9"] * 9, words=["--markers is given 9 times", "8"])
    assert not list((tmp_path / "answers").iterdir())
