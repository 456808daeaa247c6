"""The receiver in Python with datagrams that are lost, duplicated and out of order, on a simulated clock."""

import random
import struct
import time

import numpy as np
import pytest

from test_stream import python_receiver

MS = 1_000_000  # ns
RATE, PERIOD, LEAD = 40e3, 25_000, 20 * MS
SPEED = 8.0  # of the focal points [m/s]
BEGIN = 10**12  # start of the stream [ns]


def place(sample, focus):
    """x of a focal point on a line [m], up and down at SPEED."""
    phase = (SPEED * sample / RATE / 0.1 + focus / 8) % 2.0
    return 0.1 * (phase if phase < 1.0 else 2.0 - phase)


def datagram(first, count, foci):
    """The body of a BLOCK, and the time at which it is sent [ns]."""
    sent = BEGIN + first * PERIOD
    samples = [value for i in range(count) for f in range(foci)
               for value in (place(first + i, f), 0.02, 0.2, 0.5 + 0.001 * f)]
    return sent, struct.pack(f"<qqHHBBHq{len(samples)}f", first, sent + LEAD, count, 1, foci, 0, 0, 0, *samples)


class Playback:
    """A receiver and its output, in steps of one millisecond of simulated time."""

    def __init__(self, foci):
        self.rows = []
        self.receiver = python_receiver().Receiver("", 0, play=self.play)
        self.receiver.subscribed, self.receiver.has_offset = True, True
        self.foci = foci

    def play(self, at, gain, foci, sample):
        assert foci == self.foci
        self.rows.append((at, gain, *sample[::4], *sample[3::4]))

    def run(self, arrivals):
        arrivals = sorted(arrivals, key=lambda arrival: arrival[0])
        now = arrivals[0][0]
        while arrivals or now < last + 50 * MS:
            while arrivals and arrivals[0][0] <= now:
                last, body = arrivals.pop(0)
                self.receiver.heard = now
                self.receiver.take_block(body)
            self.receiver.play_due(now)
            now += MS
        return np.array(self.rows)


def arrivals_of(foci, lost, seed, seconds=1.0):
    """Datagrams of a second as delivered by a network: some lost, some duplicated, some out of order."""
    draw = random.Random(seed)
    count = 1152 // (16 * foci)
    out = []
    for n in range(int(seconds * RATE / count)):
        if n in lost:
            continue
        sent, body = datagram(n * count, count, foci)
        for _ in range(1 + (draw.random() < 0.1)):
            out.append((sent + draw.randrange(8 * MS), body))
    return out, count


@pytest.mark.parametrize("foci", [1, 2, 4, 8])
def test_single_lost_datagrams_are_concealed(foci):
    draw = random.Random(foci)
    for seed in range(5):
        datagrams = int(RATE / (1152 // (16 * foci)))
        lost = set()
        for n in range(60, datagrams - 60):
            if draw.random() < 0.02 and n - 1 not in lost:
                lost.add(n)
        arrivals, count = arrivals_of(foci, lost, seed)
        playback = Playback(foci)
        rows = playback.run(arrivals)
        counts = playback.receiver.counts
        assert counts["silences"] == 1  # the end of the stream
        assert counts["lost"] == counts["concealed"] == count * len(lost)
        full = rows[rows[:, 1] == 1.0]
        assert len(full) > 0.9 * RATE
        assert (np.diff(full[:, 0]) == PERIOD).all()
        # no step exceeds that of the samples themselves, and no intensity changes
        assert (np.abs(np.diff(full[:, 2:2 + foci], axis=0)) <= SPEED / RATE + 1e-8).all()
        assert np.allclose(full[:, 2 + foci:], 0.5 + 0.001 * np.arange(foci), atol=1e-6)


@pytest.mark.parametrize("foci", [1, 4])
def test_two_lost_datagrams_in_a_row_cause_silence(foci):
    arrivals, _ = arrivals_of(foci, {80, 81}, 1)
    playback = Playback(foci)
    playback.run(arrivals)
    assert playback.receiver.counts["silences"] == 2
    assert playback.receiver.counts["concealed"] == 0


def test_samples_that_violate_the_protocol_cause_silence():
    arrivals, count = arrivals_of(4, {80}, 1)
    sent, body = datagram(80 * count, count, 4)
    playback = Playback(4)
    playback.run([*arrivals, (sent, body[:44] + struct.pack("<f", 1.5) + body[48:])])
    assert playback.receiver.counts["malformed"] == 1
    assert playback.receiver.counts["silences"] == 2 and playback.receiver.counts["concealed"] == 0


def test_a_late_datagram_is_concealed_and_dropped():
    arrivals, count = arrivals_of(4, {80}, 1)
    sent, body = datagram(80 * count, count, 4)
    playback = Playback(4)
    playback.run([*arrivals, (sent + LEAD + 3 * MS, body)])
    assert playback.receiver.counts["silences"] == 1
    assert playback.receiver.counts["concealed"] == count and playback.receiver.counts["late"] == count


def test_the_receivers_clock_has_no_coarse_steps(monkeypatch):
    """time.monotonic() steps by 15.6 ms on Windows before Python 3.13."""

    def never(*_):
        raise AssertionError("the receiver used a coarse clock")

    for name in ("monotonic", "monotonic_ns", "time", "time_ns"):
        monkeypatch.setattr(time, name, never)
    receiver = python_receiver().Receiver("127.0.0.1", 1, udp=True)
    for _ in range(3):
        receiver.step(0.0)
    receiver.close()
