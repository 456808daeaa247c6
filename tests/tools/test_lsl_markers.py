"""The bridge from markers of prostm study run to LSL: texts and times of the stream, for datagrams as prostm sends them."""

import importlib.util
import json
import re
import socket
import subprocess
import sys
import time
import uuid
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools" / "lsl_markers.py"
spec = importlib.util.spec_from_file_location("lsl_markers", TOOL)
bridge = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bridge)


def marker(sequence, **other):
    """A datagram of prostm, docs/study/study-files.md."""
    now = time.clock_gettime(time.CLOCK_MONOTONIC)
    return {"type": "marker", "participant": "2", "run": 1, "sequence": sequence, "event": "stimulus-on", "code": 1,
            "trial": 1, "presentation": 1, "part": 1, "stream": 1, "sample": 0, "rate_hz": 40000.0, "played_s": now - 0.002,
            "played_utc_s": 0.0, "sent_s": now, "late_ms": 2.0, **other}


def test_a_marker_has_its_event_and_its_conditions():
    plain, told = marker(1), marker(1, method="am", scene="one-plume")
    assert bridge.text_of(plain, "event") == "stimulus-on"
    assert bridge.text_of(told, "event") == "stimulus-on/am/one-plume"
    assert bridge.text_of(told, "code") == "1"
    assert json.loads(bridge.text_of(told, "json")) == told


def test_times_are_those_of_the_sample():
    local = marker(1, played_s=100.0, late_ms=3.0)
    assert bridge.time_of(local, True, 5000.5, 100.5) == pytest.approx(5000.0)
    assert bridge.time_of(local, False, 5000.5, 100.5) == pytest.approx(5000.497)
    assert bridge.time_of(marker(1, played_s=None, late_ms=None), True, 5000.5, 100.5) == 5000.5


def test_lost_markers_are_counted_for_each_run():
    gaps = bridge.Gaps()
    assert [gaps.look(marker(n)) for n in (1, 2, 5, 6)] == [0, 0, 2, 0]
    assert [gaps.look(marker(n, run=2)) for n in (1, 3)] == [0, 1]


def test_other_datagrams_are_refused(capsys):
    for data in (b"", b"\xff", b"[]", b'{"type":"state"}', b'{"type":"marker"}'):
        assert bridge.read(data, "127.0.0.1") is None
        assert "is not a marker of prostm" in capsys.readouterr().err
    assert bridge.read(json.dumps(marker(1)).encode(), "127.0.0.1")["sequence"] == 1


def test_markers_arrive_in_a_stream_of_lsl():
    lsl = pytest.importorskip("mne_lsl.lsl", reason="needs mne-lsl (PyPI: pip install mne-lsl)")
    name = f"prostm-test-{uuid.uuid4().hex[:8]}"
    process = subprocess.Popen([sys.executable, str(TOOL), "--port", "0", "--name", name], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        for line in process.stdout:  # liblsl may print its configuration first
            if found := re.match(rf"stream {name}: markers from udp://127\.0\.0\.1:(\d+)$", line):
                break
        else:
            pytest.fail(process.stderr.read())
        streams = lsl.resolve_streams(timeout=20, name=name, minimum=1)
        assert [(s.name, s.stype, s.n_channels, s.sfreq) for s in streams] == [(name, "Markers", 1, 0.0)]
        inlet = lsl.StreamInlet(streams[0])
        inlet.open_stream(timeout=20)
        sent = [marker(1), marker(2, event="stimulus-off", code=2), marker(4, method="am", scene="four-plumes")]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for one in sent:
                sender.sendto(json.dumps(one).encode() + b"\n", ("127.0.0.1", int(found.group(1))))
        offset = lsl.local_clock() - time.clock_gettime(time.CLOCK_MONOTONIC)
        for one, text in zip(sent, ("stimulus-on", "stimulus-off", "stimulus-on/am/four-plumes")):
            sample, at = inlet.pull_sample(timeout=20)
            assert list(sample) == [text]
            assert at == pytest.approx(one["played_s"] + offset, abs=0.001)
    finally:
        process.terminate()
        _, errors = process.communicate(timeout=20)
    assert process.returncode == 0
    assert "markers lost before number 4: 1" in errors


def test_without_lsl_it_says_what_to_install(tmp_path):
    for name in ("mne_lsl", "pylsl"):
        (tmp_path / f"{name}.py").write_text("raise ImportError('absent')")
    done = subprocess.run([sys.executable, str(TOOL), "--port", "0"], text=True, capture_output=True,
                          env={"PYTHONPATH": str(tmp_path)})
    assert done.returncode == 1 and "pip install mne-lsl" in done.stderr and not done.stdout
