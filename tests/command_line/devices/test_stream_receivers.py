"""The receivers of examples/stream/ against a sender written here from docs/devices/stream.md, which fails on
request."""

import math
import random
import socket
import struct
import threading
import time

import numpy as np
import pytest

from test_stream import Listener, check_ramps, row_type, rows_of

MS = 1_000_000  # ns
RATE, BLOCK, LEAD = 40e3, 40, 100 * MS
HELLO, BLOCK_KIND, STATE, HEARTBEAT, TIME, END, ERROR = 16, 17, 18, 19, 20, 23, 24


class Sender:
    """Streams one focal point at rest with intensity 1, in real time, to one receiver over TCP."""

    def __init__(self):
        self.listening = socket.socket()
        self.listening.bind(("127.0.0.1", 0))
        self.listening.listen()
        self.listening.settimeout(60)
        self.port = self.listening.getsockname()[1]
        self.link, self.sequence, self.index = None, 0, 0
        self.begin = 0

    def close(self):
        for link in (self.link, self.listening):
            if link is not None:
                link.close()

    def message(self, kind, body):
        out = b"PSTM" + struct.pack("<BBHII", 1, kind, len(body), 4242, self.sequence) + body
        self.sequence += 1
        return out

    def accept(self):
        self.link, _ = self.listening.accept()
        request = b""
        while len(request) < 88:
            request += self.link.recv(88 - len(request))
        assert request[:8] == b"PSTM\1\1\x48\0" and request[20] == 1
        now = time.monotonic_ns()
        hello = struct.pack("<IBBBBHBBBBHdqqqqIIHxxxxxx", 0, 1, 1, 8, 0, 1, 0, 1, 1, 0, BLOCK, RATE, now, self.index,
                            now + LEAD, LEAD, 20_000, 5_000, 1000)
        self.link.sendall(self.message(HELLO, hello))
        threading.Thread(target=self.answer, args=(self.link,), daemon=True).start()
        self.begin = now - self.index * 25_000

    def answer(self, link):
        """Answers requests for the time."""
        try:
            while request := link.recv(24):
                if len(request) == 24 and request[5] == 2:
                    now = time.monotonic_ns()
                    link.sendall(self.message(TIME, request[16:24] + struct.pack("<qq", now, now)))
        except OSError:
            pass

    def block(self, x=0.01, intensity=1.0):
        """Sends the next block when it is due."""
        due = self.begin + self.index * 25_000
        time.sleep(max(0, due - time.monotonic_ns()) / 1e9)
        body = struct.pack("<qqHHBBHq", self.index, due + LEAD, BLOCK, 1, 1, 0, 0, 0)
        self.link.sendall(self.message(BLOCK_KIND, body + struct.pack("<4f", x, 0.02, 0.2, intensity) * BLOCK))
        self.index += BLOCK

    def leave_out(self):
        self.index += BLOCK

    def blocks(self, number, **how):
        for _ in range(number):
            self.block(**how)


def one_block_lost(sender):
    """At most as much as a datagram holds: the receiver conceals it."""
    sender.leave_out()


def gap(sender):
    for _ in range(3):
        sender.leave_out()


def not_a_number(sender):
    sender.block(intensity=math.nan)
    sender.block(x=math.inf)


def too_loud(sender):
    sender.block(intensity=1.5)


def stopped(sender):
    sender.link.sendall(sender.message(STATE, struct.pack("<HBB4xq", 1, 0, 0, sender.index)))
    time.sleep(0.08)
    sender.link.sendall(sender.message(STATE, struct.pack("<HBB4xq", 0, 2, 0, sender.index)))


def quiet(sender):
    time.sleep(0.200)


def unknown(sender):
    """A message of a later version is not an interruption."""
    sender.link.sendall(sender.message(99, b"later"))


def times_jump(sender):
    """Times later by 130 ms, as after a delay in prostm."""
    sender.begin += 130 * MS


def ended(sender):
    sender.link.sendall(sender.message(END, struct.pack("<HH", 16, 0) + b"prostm ends."))
    sender.link.close()
    sender.accept()


def refused(sender):
    sender.link.sendall(sender.message(ERROR, struct.pack("<HH", 35, 0) + b"The length is wrong."))
    sender.link.close()
    sender.accept()


def garbage(sender):
    sender.link.sendall(random.Random(1).randbytes(5000))
    sender.link.close()
    sender.accept()


def stream_until_output(sender, listener):
    begin = time.monotonic_ns()

    def sounds():
        size = row_type(1).itemsize
        whole = listener.played.stat().st_size // size if listener.played.exists() else 0
        if whole == 0:
            return False
        with listener.played.open("rb") as file:
            file.seek((whole - 1) * size)
            newest = np.frombuffer(file.read(size), row_type(1))[0]
        return newest["gain"] == 1.0 and newest["time"] > begin

    end = begin + 60_000 * MS
    while not sounds():
        assert time.monotonic_ns() < end, "it did not sound within a minute"
        sender.blocks(20)


@pytest.mark.realtime
@pytest.mark.parametrize("language", ["c++", "python"])
@pytest.mark.parametrize("fault", [unknown, one_block_lost, gap, not_a_number, too_loud, stopped, quiet, times_jump, ended, refused,
                                   garbage])
def test_any_interruption_causes_silence_and_then_the_output_resumes(program, tmp_path, language, fault):
    silences = 0 if fault in (unknown, one_block_lost) else 1
    sender = Sender()
    listener = Listener(program, tmp_path, language, "tcp", sender.port, "--silence-ms", "100")
    try:
        sender.accept()
        stream_until_output(sender, listener)
        fault(sender)
        sender.blocks(250)  # the fault has been played
        stream_until_output(sender, listener)
        time.sleep(0.3)
        statistics, printed = listener.end()
    finally:
        listener.process.kill()
        sender.close()
    played = rows_of(listener.played, foci=1)
    gain, focus = played["gain"], played["focus"][:, 0]
    assert np.isfinite(focus).all()
    # the focal point is at rest, so the intensity is the factor
    assert (0.0 <= focus[:, 3]).all() and (focus[:, 3] <= 1.0).all() and np.allclose(focus[:, 3], gain, atol=1e-6)
    falls, full = ((gain[:-1] > 0.0) & (gain[1:] == 0.0)).sum(), ((gain[:-1] < 1.0) & (gain[1:] == 1.0)).sum()
    # more if the machine is so busy that the receiver or this sender is late; the last is the end of the stream
    assert falls >= silences + 1 and statistics["silences"] >= silences + 1, printed
    assert full >= (2 if silences else 1)
    check_ramps(played)
    if fault is one_block_lost:
        # unless the machine was so busy that the receiver happened to be silent
        assert statistics["lost"] >= BLOCK and statistics["concealed"] + BLOCK * statistics["silences"] >= BLOCK
    if fault in (not_a_number, too_loud, garbage):
        assert statistics["malformed"] > 0
