#!/usr/bin/env python3
"""A receiver of prostm-stream/1 (docs/devices/stream.md) in one file, with Python's standard library alone.

    python3 prostm_receiver.py [ADDRESS:PORT] [--udp] [--seconds S] …

The class Receiver maintains the subscription and outputs each sample at its play time. It fades to silence when the
stream stops. To drive an array, pass a function of your own as `play`. main() prints statistics and writes samples to
files.
"""

import argparse
import bisect
import json
import math
import select
import signal
import socket
import struct
import sys
import time
from array import array

# Tables of docs/devices/stream.md. All numbers are little-endian.
MAGIC, VERSION = b"PSTM", 1
HEADER = struct.Struct("<4sBBHII")  # magic, version, kind, size of the body, session, sequence
SUBSCRIBE, TIME_REQUEST, BYE, HELLO, BLOCK, STATE, HEARTBEAT, TIME, END, ERROR = 1, 2, 3, 16, 17, 18, 19, 20, 23, 24
SUBSCRIBE_BODY = struct.Struct("<IBBHB63x")  # token, want, foci, stride, flags
REQUEST_BODY = struct.Struct("<q")  # a time [ns], or a token
HELLO_BODY = struct.Struct("<IBBBBHBBBxHdqqqqIIH6x")
BLOCK_HEAD = struct.Struct("<qqHHBBHq")  # index, play time [ns], count, stride, foci, flags, 0, skipped
STATE_HEAD = struct.Struct("<HBB4xq")  # reason, state, 0, index
HEARTBEAT_BODY = struct.Struct("<qqB7x")  # time [ns], next index, state
TIME_BODY = struct.Struct("<qqq")  # asked, received, sent [ns]
FOCUS_BYTES = 16  # x, y, z [m] and the intensity 0..1, each a float
WANT_SAMPLES = 1

MS = 1_000_000  # ns
DATAGRAM = 1200 - HEADER.size - BLOCK_HEAD.size  # most bytes of samples in a datagram
CONCEALED = 2 * MS  # longest gap that is concealed
READS_AT_ONCE = 64
RENEW_EVERY = 250 * MS
STALL = 20 * MS  # longest time between two calls of step() without a restart of the output
GONE_AFTER = 1000 * MS  # time without a message before it reconnects


class Block:
    """Consecutive samples: `data` has four floats for each focal point of each sample."""

    def __init__(self, index, play_time, stride, foci, data):
        self.index, self.time, self.stride, self.foci, self.data = index, play_time, stride, foci, data

    @property
    def count(self):
        return len(self.data) // (4 * self.foci)

    def sample(self, i):
        return self.data[4 * self.foci * i:4 * self.foci * (i + 1)]


class Receiver:
    """Receives a stream and plays it; call step() about once a millisecond.

    play(time_ns, gain, foci, sample) is called for each output sample, with the time by this machine's steady clock
    (time.perf_counter_ns), the gain that the intensities contain (1 if the stream is not interrupted), the number of
    focal points, and four floats for each: x, y, z [m] and the intensity 0..1.
    """

    def __init__(self, host, port, udp=False, foci=0, every=1, shared=False, silence_after=20 * MS, ramp=5 * MS,
                 play=None, on_block=None, on_event=None):
        self.address, self.udp = (host, port), udp
        self.foci, self.every, self.shared = foci, every, shared
        self.silence_after, self.ramp = silence_after, ramp
        self.play = play or (lambda *_: None)
        self.on_block = on_block or (lambda _: None)
        self.on_event = on_event or (lambda _: None)
        self.counts = dict.fromkeys(
            ("samples", "lost", "concealed", "late", "skipped", "silences", "malformed", "subscriptions"), 0)
        self.round_trip = 0
        self.socket, self.session, self.sequence, self.heard = None, 0, 0, 0
        self.tried = -GONE_AFTER
        self.offset = self.wanted_offset = 0.0  # prostm's clock minus this machine's [ns]
        self.gain, self.falling, self.held, self.last = 0.0, True, None, 0
        self.reset()

    def reset(self):
        """Resets the state after a restart of prostm, which has a new clock and new sample indices."""
        self.subscribed = self.stopped = self.has_offset = False
        self.blocks = []  # sorted by index
        self.next_index = None  # index of the next sample to play
        self.next_time = 0  # its play time by prostm's clock
        self.rejected = -1  # index of the newest sample that violated the protocol
        self.best_trip, self.best_at = 0, 0
        self.rate = 40e3

    # the connection

    def connect(self, now):
        if now - self.tried < 200 * MS:
            return
        self.tried = now
        family, kind, _, _, address = socket.getaddrinfo(
            *self.address, type=socket.SOCK_DGRAM if self.udp else socket.SOCK_STREAM)[0]
        link = socket.socket(family, kind)
        try:
            link.settimeout(1.0)
            link.connect(address)
            if not self.udp:
                link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            else:
                link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        except OSError:
            link.close()
            return
        link.setblocking(False)
        self.socket, self.unread = link, b""
        self.token, self.requested, self.requests = 0, 0, 0
        self.opened = time.perf_counter_ns()

    def disconnect(self):
        if self.socket is not None:
            self.socket.close()
        self.socket, self.subscribed = None, False

    def close(self):
        if self.socket is not None:
            self.send(BYE, REQUEST_BODY.pack(self.token))
        self.disconnect()

    def send(self, kind, body):
        message = HEADER.pack(MAGIC, VERSION, kind, len(body), self.session, self.sequence) + body
        self.sequence = (self.sequence + 1) & 0xFFFFFFFF
        try:
            self.socket.send(message)
        except (BlockingIOError, ConnectionRefusedError):
            pass
        except OSError:
            self.disconnect()

    def renew(self, now):
        """Renews the subscription and requests the time, often at first."""
        if self.requests > 0 and now - self.requested < (20 * MS if self.requests < 10 else RENEW_EVERY):
            return
        self.requested = now
        if self.requests == 0 or self.udp:
            self.send(SUBSCRIBE, SUBSCRIBE_BODY.pack(self.token, WANT_SAMPLES, self.foci, self.every, int(self.shared)))
        self.requests += 1
        if self.subscribed and self.socket is not None:
            self.send(TIME_REQUEST, REQUEST_BODY.pack(time.perf_counter_ns()))

    def step(self, wait=0.001):
        """Sends due messages, receives for at most `wait` seconds, and plays the samples that are due."""
        now = time.perf_counter_ns()
        if self.socket is None:
            self.connect(now)
        if self.socket is None:
            time.sleep(wait)
        else:
            self.renew(now)
        if self.socket is not None and select.select([self.socket], [], [], wait)[0]:
            self.receive()
        if self.socket is not None and time.perf_counter_ns() - max(self.opened, self.heard) > GONE_AFTER:
            self.disconnect()
        self.play_due(time.perf_counter_ns())

    def receive(self):
        """Processes the received messages, at most READS_AT_ONCE reads so that renewals are not delayed."""
        for _ in range(READS_AT_ONCE):
            if self.socket is None:
                return None
            try:
                data = self.socket.recv(1 << 16)
            except (BlockingIOError, ConnectionRefusedError):
                return None
            except OSError:
                return self.disconnect()
            if not data and not self.udp:
                return self.disconnect()
            self.unread = data if self.udp else self.unread + data
            self.take_messages()
        return None

    def take_messages(self):
        while len(self.unread) >= HEADER.size and self.socket is not None:
            magic, version, kind, size, session, _ = HEADER.unpack_from(self.unread)
            if magic != MAGIC or version != VERSION:
                self.counts["malformed"] += 1
                self.unread = b""
                return None if self.udp else self.disconnect()
            if len(self.unread) < HEADER.size + size:
                return None
            body, self.unread = self.unread[HEADER.size:HEADER.size + size], self.unread[HEADER.size + size:]
            if session != self.session:
                self.reset()
            self.session, self.heard = session, time.perf_counter_ns()
            try:
                self.take(kind, body)
            except struct.error:
                self.counts["malformed"] += 1
        return None

    def take(self, kind, body):
        if kind == HELLO:
            self.take_hello(body)
        elif kind == BLOCK:
            self.take_block(body)
        elif kind == STATE:
            _, state, _, _ = STATE_HEAD.unpack_from(body)
            self.stopped = state == 0
            words = {0: "stopped.", 1: "silent.", 2: "playing."}.get(state, "in an unknown state.")
            self.on_event(f"{words} {body[STATE_HEAD.size:].decode('utf-8', 'replace')}")
        elif kind == HEARTBEAT:
            self.stopped = HEARTBEAT_BODY.unpack(body)[2] == 0
        elif kind == TIME:
            self.take_time(*TIME_BODY.unpack(body))
        elif kind in (END, ERROR):
            self.on_event(("end: " if kind == END else "error: ") + body[4:].decode("utf-8", "replace"))
            self.disconnect()

    def take_hello(self, body):
        fields = HELLO_BODY.unpack(body)
        self.token, subscribed, rate, sent = fields[0], fields[1], fields[10], fields[11]
        if not subscribed or self.subscribed:
            return
        self.subscribed, self.rate = True, rate
        self.counts["subscriptions"] += 1
        if not self.has_offset:
            self.offset = self.wanted_offset = float(sent - self.heard)

    def take_time(self, asked, received, sent):
        """Uses the exchange with the shortest round trip of the last seconds, which has the smallest error."""
        trip = (self.heard - asked) - (sent - received)
        if not 0 <= trip <= 1000 * MS:
            return
        self.round_trip = trip
        if self.has_offset and trip > self.best_trip and self.heard - self.best_at < 3000 * MS:
            return
        self.best_trip, self.best_at = trip, self.heard
        self.wanted_offset = ((received - asked) + (sent - self.heard)) / 2
        if not self.has_offset:
            self.offset = self.wanted_offset
        self.has_offset = True

    def take_block(self, body):
        index, play_time, count, stride, foci, _, _, skipped = BLOCK_HEAD.unpack_from(body)
        data = array("f")
        if not 1 <= foci <= 8 or stride != self.every or len(body) != BLOCK_HEAD.size + count * foci * FOCUS_BYTES:
            self.counts["malformed"] += 1
            return
        data.frombytes(body[BLOCK_HEAD.size:])
        if sys.byteorder == "big":
            data.byteswap()
        self.counts["samples"] += count
        self.counts["skipped"] = skipped
        if count == 0:
            return
        if not math.isfinite(sum(data)) or not 0.0 <= min(data[3::4]) <= max(data[3::4]) <= 1.0:
            self.counts["malformed"] += 1
            self.rejected = max(self.rejected, index + (count - 1) * stride)
            return
        if play_time < self.heard + self.offset:
            self.counts["late"] += count
        block = Block(index, play_time, stride, foci, data)
        self.on_block(block)
        # datagrams may arrive out of order
        bisect.insort(self.blocks, block, key=lambda b: b.index)

    # the output

    def period(self):
        return round(1e9 / self.rate * self.every)

    def play_due(self, now):
        """Plays all samples up to a time of this machine's clock, with the silence rule applied."""
        # during output the clock offset is adjusted slowly, so that no sample is skipped
        change = 1e-3 * (now - self.last) if self.gain > 0.0 else math.inf
        self.offset += min(change, max(-change, self.wanted_offset - self.offset))
        until = now + self.offset
        if now - self.last > STALL and self.held is not None:  # step() was not called for too long: skip
            if self.next_index is not None:
                self.interrupt()
            self.gain, self.next_time = 0.0, until
            self.hand_over(until, self.held)
        self.last = now
        good = self.subscribed and not self.stopped and now - self.heard <= self.silence_after
        while good and self.blocks:
            self.conceal(until)
            if self.blocks[0].time > until or not self.play_block(until):
                break
        overdue = self.next_index is not None and self.next_time + self.period() // 2 < until
        if self.next_index is not None and (not good or overdue):
            self.interrupt()
        if self.falling:
            self.fall(until)

    def conceal(self, until):
        """Fills a due gap of at most one datagram by linear interpolation between the samples around it."""
        after, period = self.blocks[0], self.period()
        if self.next_index is None or self.next_time > until:
            return
        missing = (after.index - self.next_index) // after.stride
        foci, last = self.held
        gap = missing * period
        if not 0 < missing <= DATAGRAM // (foci * FOCUS_BYTES) or gap > CONCEALED or after.foci != foci:
            return
        if abs(after.time - gap - self.next_time) > period:  # the play times jump
            return
        if self.next_index <= self.rejected < after.index:  # rejected, not lost
            return
        first, data = after.sample(0), array("f")
        for i in range(1, missing + 1):
            share = i / (missing + 1)
            data.extend(a + share * (b - a) for a, b in zip(last, first))
        self.blocks.insert(0, Block(self.next_index, self.next_time, after.stride, foci, data))
        self.counts["lost"] += missing
        self.counts["concealed"] += missing

    def play_block(self, until):
        """Plays the due samples of the first block; false if some of its samples are not due yet."""
        block, period = self.blocks[0], self.period()
        if self.next_index is None:
            if self.gain > 0.0:  # finish the fade-out first
                self.fall(until)
            if self.gain > 0.0:
                return False
            begin = max(0, math.ceil((until - block.time) / period) - 1)  # past samples are skipped
            if begin >= block.count:
                self.blocks.pop(0)
                return True
            self.falling = False
        else:
            begin = (self.next_index - block.index) // block.stride
            if begin >= block.count:  # already played
                self.blocks.pop(0)
                return True
            time_of_next = block.time + begin * period
            if begin < 0 or abs(time_of_next - self.next_time) > period:
                self.counts["lost"] += max(0, -begin)
                self.interrupt()
                return True
        i = begin
        while i < block.count and block.time + i * period <= until:
            self.gain = min(1.0, self.gain + period / self.ramp)
            self.held = (block.foci, block.sample(i))
            self.hand_over(block.time + i * period, self.held)
            i += 1
        self.next_index, self.next_time = block.index + i * block.stride, block.time + i * period
        if i < block.count:
            return False
        self.blocks.pop(0)
        return True

    def interrupt(self):
        """Starts a fade-out: the focal points stay at their positions while their intensity falls to 0."""
        self.counts["silences"] += 1
        self.falling, self.next_index = True, None

    def fall(self, until):
        while self.gain > 0.0 and self.next_time <= until:
            self.gain = max(0.0, self.gain - self.period() / self.ramp)
            self.hand_over(self.next_time, self.held)
            self.next_time += self.period()

    def hand_over(self, at, held):
        foci, sample = held
        if self.gain < 1.0:
            sample = array("f", sample)
            for i in range(3, len(sample), 4):
                sample[i] *= self.gain
        self.play(round(at - self.offset), self.gain, foci, sample)

    def statistics(self):
        buffered = self.blocks[-1].time - self.next_time if self.blocks and self.next_index is not None else 0
        return {**self.counts, "round_trip_ms": self.round_trip / MS, "offset_ms": self.offset / MS,
                "buffered_ms": buffered / MS}


class SampleFile:
    """Writes one row per sample: CSV if the name ends in .csv, else i64, i64, i32, f32 and four f32 per focal point."""

    ROW = struct.Struct("<qqif")

    def __init__(self, name, first_column):
        self.file = None
        if name:
            self.csv = name.endswith(".csv")
            self.file = open(name, "w" if self.csv else "wb", encoding="ascii" if self.csv else None)
            if self.csv:
                self.file.write(f"{first_column},time_ns,foci,gain,x_m,y_m,z_m,intensity,...\n")

    def row(self, first, at, foci, gain, sample):
        if self.file is None:
            return
        if self.csv:
            self.file.write(",".join(map(repr, [first, at, foci, gain, *sample])) + "\n")
        else:
            self.file.write(self.ROW.pack(first, at, foci, gain) + sample.tobytes())

    def close(self):
        if self.file is not None:
            self.file.close()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("address", nargs="?", default="127.0.0.1:7140", help="where prostm serves; default %(default)s")
    parser.add_argument("--udp", action="store_true", help="subscribe over UDP, not TCP")
    parser.add_argument("--foci", type=int, default=0, choices=range(9), help="number of focal points; 0: all")
    parser.add_argument("--every", type=int, default=1, help="receive every N-th sample, 1 to 1000")
    parser.add_argument("--shared", action="store_true", help="one intensity for all focal points of a sample")
    parser.add_argument("--silence-ms", type=float, default=20.0,
                        help="time without a message after which the output falls silent")
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--received", metavar="FILE", help="write the received samples (.csv, or binary)")
    parser.add_argument("--played", metavar="FILE", help="write the played samples, with the silence rule applied")
    given = parser.parse_args()
    if not 1 <= given.every <= 1000:
        parser.error("--every must be 1 to 1000")
    if not 1 <= given.silence_ms <= 100:
        parser.error("--silence-ms must be 1 to 100")
    return given


def main():
    given = arguments()
    host, _, port = given.address.rpartition(":")
    received, played = SampleFile(given.received, "index"), SampleFile(given.played, "handed_ns")

    def on_block(block):
        period = 1e9 / receiver.rate
        if received.file is not None:
            for i in range(block.count):
                index = i * block.stride
                received.row(block.index + index, block.time + round(index * period), block.foci, 1.0, block.sample(i))

    def play(at, gain, foci, sample):
        # call the library of an array here
        played.row(time.perf_counter_ns(), at, foci, gain, sample)
        if gain == 0.0:
            print(f"silent {(at - receiver.heard) / MS:.1f} ms after the last message", flush=True)

    receiver = Receiver(host.strip("[]"), int(port), given.udp, given.foci, given.every, given.shared,
                        round(given.silence_ms * MS), play=play, on_block=on_block,
                        on_event=lambda sentence: print(sentence, flush=True))

    def interrupt(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    begin = next_line = time.perf_counter()
    try:
        while time.perf_counter() - begin < given.seconds:
            receiver.step()
            if time.perf_counter() - next_line >= 1.0:
                next_line += 1.0
                print(json.dumps(receiver.statistics()), flush=True)
    except KeyboardInterrupt:
        pass
    receiver.close()
    received.close()
    played.close()
    print(json.dumps(receiver.statistics()), flush=True)


if __name__ == "__main__":
    main()
