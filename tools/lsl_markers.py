#!/usr/bin/env python3
"""Passes the markers of prostm study run on to the Lab Streaming Layer (LSL), as a stream of the type Markers.

usage: lsl_markers.py [--port PORT] [--name NAME] [--content event|code|json]

    --port PORT      UDP port of 127.0.0.1 to receive markers on (default: 8480; 0: any free one, which is printed)
    --address HOST   address to receive them on (default: 127.0.0.1; 0.0.0.0: from other machines, too)
    --name NAME      name of the stream (default: prostm)
    --content WHAT   text of each marker: the event, with method and scene if the protocol discloses them, as
                     stimulus-on/am/one-plume (default); the code for trigger boxes; or the whole datagram as JSON

Start it before `prostm study run … --markers udp://127.0.0.1:PORT`. It runs until Ctrl-C. Needs mne-lsl (PyPI; its
wheels contain liblsl), or pylsl with liblsl. The datagrams are described in docs/study/study-files.md.

The time stamp of a marker is the time at which its sample leaves the array. On the machine that runs prostm it is
computed from played_s, since LSL's clock and played_s both count with the monotonic clock. From another machine it is the
time of arrival minus late_ms, so it is late by the time in the network.
"""

import argparse
import json
import signal
import socket
import sys
import time


def open_outlet(name):
    """Returns push(text, time) and LSL's clock [s]. Exits with a message if there is no LSL."""
    try:
        from mne_lsl.lsl import StreamInfo, StreamOutlet, local_clock
        outlet = StreamOutlet(StreamInfo(name, "Markers", 1, 0.0, "string", f"prostm-{name}"))
        return (lambda text, at: outlet.push_sample([text], at)), local_clock
    except ImportError as error:
        without_mne = error
    try:
        from pylsl import StreamInfo, StreamOutlet, local_clock
    except (ImportError, RuntimeError) as error:
        sys.exit(f"lsl_markers needs mne-lsl (pip install mne-lsl) or pylsl with liblsl: {without_mne}; {error}")
    outlet = StreamOutlet(StreamInfo(name, "Markers", 1, 0.0, "string", f"prostm-{name}"))
    return (lambda text, at: outlet.push_sample([text], at)), local_clock


def text_of(marker, content):
    """Returns the text of a marker."""
    if content == "json":
        return json.dumps(marker)
    if content == "code":
        return str(marker["code"])
    return "/".join([marker["event"]] + [marker[key] for key in ("method", "scene") if key in marker])


def time_of(marker, is_local, lsl_now, monotonic_now):
    """Returns the time of a marker by LSL's clock [s], given the times of its arrival by both clocks [s]."""
    if marker["played_s"] is None:
        return lsl_now
    if is_local:
        return marker["played_s"] + lsl_now - monotonic_now
    return lsl_now - 1e-3 * marker["late_ms"]


class Gaps:
    """Finds markers that were lost between prostm and here."""

    def __init__(self):
        self.last = {}

    def look(self, marker):
        """Returns how many markers are missing before this one."""
        run = marker["participant"], marker["run"]
        missing = marker["sequence"] - self.last.get(run, marker["sequence"] - 1) - 1
        self.last[run] = marker["sequence"]
        return max(0, missing)


def read(data, sender):
    """Returns the marker of a datagram, or None, with a message, if it is not one."""
    try:
        marker = json.loads(data)
        if marker["type"] != "marker":
            raise ValueError(f"its type is {marker['type']!r}")
        for key in ("event", "code", "participant", "run", "sequence", "played_s", "late_ms"):
            marker[key]
    except (ValueError, KeyError, TypeError) as error:
        print(f"a datagram from {sender} is not a marker of prostm: {error!r}", file=sys.stderr)
        return None
    return marker


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--port", type=int, default=8480, help="UDP port, 0 for any")
    parser.add_argument("--address", default="127.0.0.1", help="address to receive on")
    parser.add_argument("--name", default="prostm", help="name of the stream")
    parser.add_argument("--content", choices=("event", "code", "json"), default="event", help="text of each marker")
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    push, lsl_clock = open_outlet(given.name)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        try:
            receiver.bind((given.address, given.port))
        except (OSError, OverflowError) as error:
            print(f"cannot receive on {given.address}, port {given.port}: {error}", file=sys.stderr)
            return 2
        print(f"stream {given.name}: markers from udp://{given.address}:{receiver.getsockname()[1]}", flush=True)
        gaps = Gaps()
        while True:
            data, (sender, _) = receiver.recvfrom(65536)
            lsl_now, monotonic_now = lsl_clock(), time.clock_gettime(time.CLOCK_MONOTONIC)
            marker = read(data, sender)
            if marker is None:
                continue
            missing = gaps.look(marker)
            if missing > 0:
                print(f"markers lost before number {marker['sequence']}: {missing}; the participant's file has them",
                      file=sys.stderr)
            push(text_of(marker, given.content), time_of(marker, sender.startswith("127."), lsl_now, monotonic_now))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(0)
