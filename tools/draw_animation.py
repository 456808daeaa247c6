#!/usr/bin/env python3
"""Draws the README's animation: a hand in four plumes of smoke, the pressure on it, the paths of the focal points, and
what a model of the skin feels of them, as an animated SVG.

usage: PYTHONPATH=build/release/python tools/draw_animation.py PROSTM OUTPUT.svg

A run of PROSTM is stepped through the protocol of its page (docs/reference/wire.md) with a hand that moves in a closed
curve; its second round is drawn. `prostm field` computes the percept of each plan.
"""

import json
import math
import os
import socket
import struct
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import prostm

ROUND = 5.0  # of the hand [s]
UPDATE = 0.04  # between two plans [s]
SHOWN = 0.08  # for which a plan is shown [s]
SLOWER = 50  # the focal points are shown this many times slower
WIDTH, HEIGHT = 830, 470  # pixels

# the scene
TURN, ELEVATION, SCALE, MIDDLE, FLOOR = math.radians(13), math.radians(34), 1.25, 206, 366  # pixels per mm, pixels
BONES = [(1, 2), (2, 3), (3, 4), (4, 5), *((j + k, j + k + 1) for j in (6, 11, 16, 21) for k in range(4))]
PALM = [1, 2, 3, 7, 12, 17, 22, 21]

# the maps: middles on the screen, pixels per mm
MAPS, MAP_Y, MAP_SCALE = (520, 716), 208, 1.06
LEAST_DB = -24
LEVELS = 8
CHART = (430, 390, 378, 50, -14, 2)  # left, top, width, height, lowest and highest dB

LEAST_BEND = 0.4  # pixels
SMOKE = (4, 12, 22, 34, 48, 64, 82)  # density times depth [mm]
PATHS = ["#ff9f4a", "#5cc3ff", "#4fe0ab", "#ff8fd0"]


class Page:
    """Reads the frames of a run, and steps it."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.stream = self.socket.makefile("rb")
        self.socket.sendall(f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"
                            "Upgrade: websocket\r\nConnection: Upgrade\r\n"
                            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode())
        while self.stream.readline().strip():
            pass

    def say(self, **message):
        text = json.dumps(message).encode()
        size = bytes([0x80 | len(text)]) if len(text) < 126 else b"\xfe" + len(text).to_bytes(2, "big")
        self.socket.sendall(b"\x81" + size + bytes(4) + text)

    def message(self):
        """Returns the next message: text, or the sections of a frame as id -> (count, contents)."""
        first, size = self.stream.read(2)
        if size >= 126:
            size = int.from_bytes(self.stream.read(2 if size == 126 else 8), "big")
        message = self.stream.read(size)
        if first & 15 != 2:
            return json.loads(message) if first & 15 == 1 else {}
        sections, at = {}, 16
        for _ in range(struct.unpack_from("<H", message, 6)[0]):
            kind, count, size = struct.unpack_from("<HHI", message, at)
            sections[kind] = count, message[at + 8:at + 8 + size]
            at += 8 + -(-size // 8) * 8
        return sections


def move_hand(page, time):
    """Sends the hand's pose of a time [s]: it sinks, tilts and closes a little, and rises again."""
    a = 2 * math.pi * time / ROUND
    page.say(type="hand", side="right", palm_mm=[round(12 * math.sin(a), 2), round(6 * math.cos(a), 2),
                                                 round(205 + 25 * math.cos(a), 2)],
             yaw_deg=0, pitch_deg=round(-3 + 5 * math.sin(a), 2), roll_deg=round(9 * math.sin(a), 2),
             closure=round(0.08 - 0.08 * math.cos(a), 3))


@dataclass
class Moment:
    """One plan of the run."""
    time: float  # [s]
    joints: np.ndarray  # (26, 8): position, quaternion, radius [m]
    smoke: tuple  # density (z, y, x), corner [m], edge [m]
    paths: list  # (points, 3) on the skin, and (points, 2) in the plane [m]


def read_moment(time, sections, smoke):
    edge = struct.unpack_from("<4f", smoke, 4)
    n = struct.unpack_from("<I", smoke)[0]
    density = np.frombuffer(smoke, np.uint8, n ** 3, 24).reshape(n, n, n) / 255
    paths, at, contents = [], 0, sections[6][1]
    for _ in range(sections[6][0]):
        count = struct.unpack_from("<I", contents, at + 8)[0]
        points = np.frombuffer(contents, "<f4", 6 * count, at + 32).reshape(count, 6)
        paths.append((points[:, 3:], points[:, :2]))
        at += 32 + 24 * count
    joints = np.frombuffer(sections[3][1], "<f4", 26 * 8, 16).reshape(26, 8)
    return Moment(time, joints, (density, np.array(edge[:3]), edge[3]), paths)


def watch(program, folder):
    """Runs the scene for two rounds of the hand; returns the moments of the second, and the transducers [mm]."""
    seconds = 2 * ROUND + 1
    process = subprocess.Popen([program, "run", "--view", "--view-port", "0", "--scene", "four-plumes", "--record",
                                "run.h5", "--seconds", str(seconds)], cwd=folder, stdout=subprocess.PIPE, text=True)
    page = Page(int(process.stdout.readline().split()[1].rstrip("/").rsplit(":", 1)[1]))
    page.say(type="rate", hz=60)
    page.say(type="transport", do="pause")
    moments, transducers, smoke, last = [], [], b"", -1.0
    while last < seconds - 0.5:
        message = page.message()
        transducers = message.get("array", {}).get("transducers_mm", transducers)
        if 1 not in message:
            continue
        smoke = message[4][1] if 4 in message else smoke
        time, flags = struct.unpack_from("<d", message[1][1])[0], struct.unpack_from("<I", message[1][1], 24)[0]
        if flags & 1 and time > last:
            last = time
            if ROUND + 0.5 < time < 2 * ROUND + 0.5 + UPDATE / 2 and message[3][0] and message[6][0]:
                moments.append(read_moment(time, message, smoke))
            move_hand(page, time + UPDATE)
            page.say(type="transport", do="step")
    page.say(type="transport", do="play")
    process.communicate(timeout=60)
    return moments, np.array(transducers)


@dataclass
class Percept:
    """A target and what the skin model feels of its plan."""
    target: object  # TargetField
    felt_db: np.ndarray  # above the threshold of touch, NaN where there is no skin
    level: float  # strongest place [dB]
    shape: float


def percept(program, result, folder):
    target = result.target.patches[0]
    plan = json.loads(prostm.plan_to_json(result.plan, target, result.settings))
    plan["full_scale_pressure"] = result.emission.full_scale_pressure
    (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    prostm.write_field(folder / "field.json", target)
    done = subprocess.run([program, "field", "plan.json", "--field", "field.json", "--json", "-"], cwd=folder,
                          check=True, capture_output=True, text=True)
    field = json.loads(done.stdout)
    level = field["felt"]["sensation"]["level_db"]
    felt = np.array(field["felt_um"], dtype=float) / field["felt"]["largest_um"]
    return Percept(target, level + 20 * np.log10(np.maximum(felt, 1e-6)), level, field["quality"]["felt_skill"])


def percepts(program, moments, folder):
    """Returns the percept of each moment."""
    recording = prostm.Recording(folder / "run.h5")
    frames = [int(np.argmin(np.abs(recording.time - m.time))) for m in moments]
    return [percept(program, recording.plan(frame), folder) for frame in frames]


def field_colour(t):
    """The colour of the figures' fields, evenly lighter from violet to yellow (web/src/colours.ts)."""
    lightness, hue = 0.24 + 0.7 * t, math.radians(305 - 203 * t)
    for chroma in np.arange(0.16, 0, -0.002):
        a, b = chroma * math.cos(hue), chroma * math.sin(hue)
        lms = np.array([lightness + 0.3963377774 * a + 0.2158037573 * b,
                        lightness - 0.1055613458 * a - 0.0638541728 * b,
                        lightness - 0.0894841775 * a - 1.291485548 * b]) ** 3
        rgb = np.array([[4.0767416621, -3.3077115913, 0.2309699292], [-1.2684380046, 2.6097574011, -0.3413193965],
                        [-0.0041960863, -0.7034186147, 1.7076147010]]) @ lms
        if rgb.min() >= -0.001 and rgb.max() <= 1.001:
            break
    rgb = np.clip(rgb, 0, 1)
    rgb = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
    return "#" + "".join(f"{round(255 * c):02x}" for c in rgb)


# for the corners of a square above 0 (bits: low left, low right, high right, high left) the sides between which a
# contour crosses it: 0 low, 1 right, 2 high, 3 left
CROSSINGS = {1: [(0, 3)], 2: [(1, 0)], 4: [(2, 1)], 8: [(3, 2)], 3: [(1, 3)], 6: [(2, 0)], 12: [(3, 1)], 9: [(0, 2)],
             7: [(2, 3)], 14: [(3, 0)], 13: [(0, 1)], 11: [(1, 2)], 5: [(0, 3), (2, 1)], 10: [(1, 0), (3, 2)]}
SIDES = [((0, 0), (0, 1)), ((0, 1), (1, 1)), ((1, 0), (1, 1)), ((0, 0), (1, 0))]


def contours(values):
    """Returns the closed curves around values above 0, as arrays of (column, row)."""
    grid = np.pad(values, 1, constant_values=-1.0)
    inside = grid > 0
    kinds = inside[:-1, :-1] + 2 * inside[:-1, 1:] + 4 * inside[1:, 1:] + 8 * inside[1:, :-1]
    following = {}
    for row, col in zip(*np.nonzero((kinds > 0) & (kinds < 15))):
        for ends in CROSSINGS[int(kinds[row, col])]:
            begin, end = (tuple((row + a, col + b) for a, b in SIDES[side]) for side in ends)
            following[begin] = end
    curves = []
    while following:
        start, side = following.popitem()
        curve = []
        while True:
            (r0, c0), (r1, c1) = side
            share = grid[r0, c0] / (grid[r0, c0] - grid[r1, c1])
            curve.append((c0 + share * (c1 - c0) - 1, r0 + share * (r1 - r0) - 1))
            if side == start:
                break
            side = following.pop(side)
        curves.append(np.array(curve))
    return curves


def curve_text(points, closed=True):
    """Returns pixels as the text of an SVG path, in halves of a pixel."""
    points = np.asarray(points)
    for first in (1, 2):  # leave out points that lie on the line between their neighbours
        middle = points[first:-1:2]
        before, after = points[first - 1:-2:2][:len(middle)], points[first + 1::2][:len(middle)]
        (ax, ay), (bx, by) = (after - before).T, (middle - before).T
        off = np.abs(ax * by - ay * bx) / np.maximum(np.hypot(ax, ay), 1e-9)
        points = np.delete(points, first + 2 * np.nonzero(off < LEAST_BEND)[0], axis=0)
    whole = np.rint(2 * points).astype(int)
    keep = np.concatenate([[True], np.any(np.diff(whole, axis=0) != 0, axis=1)])
    whole = whole[keep]
    if len(whole) < 2:
        return ""
    steps = " ".join(f"{x} {y}" for x, y in np.diff(whole, axis=0)).replace(" -", "-")
    return f"M{whole[0, 0]} {whole[0, 1]}l{steps}" + ("z" if closed else "")


def path(text, **attributes):
    """Returns a path of SVG; underscores in the names of attributes stand for hyphens."""
    pairs = " ".join(f'{name.replace("_", "-")}="{value}"' for name, value in attributes.items())
    return f'<path d="{text}" {pairs}/>' if text else ""


def blur(values, times=1):
    for _ in range(times):
        for axis in (0, 1):
            before, after = np.roll(values, 1, axis), np.roll(values, -1, axis)
            values = (before + 2 * values + after) / 4
    return values


def on_screen(positions):
    """Returns the pixels of positions in frame D [mm], seen obliquely from above."""
    x, y, z = np.asarray(positions, dtype=float).T
    across = x * math.cos(TURN) - y * math.sin(TURN)
    away = x * math.sin(TURN) + y * math.cos(TURN)
    up = z * math.cos(ELEVATION) + away * math.sin(ELEVATION)
    return np.stack([MIDDLE + SCALE * across, FLOOR - SCALE * up], 1)


def draw_array(transducers):
    pixels = on_screen(transducers)
    wide = SCALE * 9.2  # in halves of a pixel, like the positions
    corners = on_screen([(x, y, -3) for x, y in ((-86, -86), (86, -86), (86, 86), (-86, 86))])
    return path(curve_text(corners), **{"class": "p"}) + '<g class="a">' + "".join(
        f'<ellipse cx="{2 * x:.0f}" cy="{2 * y:.0f}" rx="{wide:.0f}" ry="{wide * math.sin(ELEVATION):.0f}"/>'
        for x, y in pixels) + "</g>"


def draw_jets(smoke):
    """Draws where the smoke enters the box, on the array."""
    density, corner, edge = smoke
    cell = edge / len(density)
    curves = contours(density[0] - 0.5 * density[0].max())
    places = [np.column_stack([corner[:2] + (c + 0.5) * cell, np.zeros(len(c))]) for c in curves]
    return path("".join(curve_text(on_screen(1e3 * p)) for p in places), **{"class": "j"})


def draw_smoke(smoke):
    density, corner, edge = smoke
    n, fine = len(density), 2
    at = (np.arange(n * fine) + 0.5) / fine - 0.5
    for axis in range(3):
        low = np.clip(np.floor(at).astype(int), 0, n - 2)
        share = np.expand_dims(np.clip(at - low, 0, 1), [a for a in range(3) if a != axis])
        density = np.take(density, low, axis) * (1 - share) + np.take(density, low + 1, axis) * share
    z, y, x = np.meshgrid(*[(np.arange(n * fine) + 0.5) * edge / n / fine] * 3, indexing="ij")
    places = 1e3 * (np.stack([x, y, z], -1).reshape(-1, 3) + corner)
    shown = (density.ravel() > 0.002)
    cell = 6.0  # pixels
    pixels = on_screen(places[shown]) / cell
    image = np.zeros((96, 96))
    whole = np.floor(pixels).astype(int)
    part = pixels - whole
    for dx in (0, 1):
        for dy in (0, 1):
            share = np.abs(1 - dx - part[:, 0]) * np.abs(1 - dy - part[:, 1])
            good = np.all((whole >= 0) & (whole < 94), axis=1)
            np.add.at(image, (whole[good, 1] + dy, whole[good, 0] + dx), (share * density.ravel()[shown])[good])
    image = blur(image, 2) * (1e3 * edge / n / fine) ** 3 / (cell / SCALE) ** 2  # density times depth [mm]
    out = []
    for level in SMOKE:
        out.append(path("".join(curve_text(cell * c) for c in contours(image - level) if len(c) > 5)))
    return '<g class="s"><g filter="url(#d)">' + "".join(out) + "</g></g>"


def draw_hand(joints):
    pixels = on_screen(1e3 * joints[:, :3])
    lines = []
    for a, b in BONES:
        width = 2 * SCALE * 1e3 * (joints[a, 7] + joints[b, 7])
        lines.append(path(curve_text(pixels[[a, b]], closed=False), stroke_width=f"{width:.0f}"))
    return '<g class="h">' + path(curve_text(pixels[PALM]), fill="#ffc9b0", stroke_width=34) + "".join(lines) + "</g>"


class Raster:
    """Places the cells of a target in its plane and in the scene, and draws filled contours on its skin."""

    def __init__(self, target):
        self.target = target
        self.skin = blur(np.pad(target.skin.astype(float), 1)) - 0.45
        pose = target.X_DP
        self.turn, self.place = pose[:3, :3], pose[:3, 3]
        self.centre = (self.turn.T @ -self.place)[:2]  # of the array, in the plane

    def plane(self, curve):
        return np.asarray(self.target.origin) + self.target.cell * (curve - 1)

    def scene(self, curve):
        """Returns the pixels of a curve on the skin in the scene."""
        flat = self.plane(curve)
        places = np.column_stack([flat, prostm.height_at(self.target, flat)]) @ self.turn.T + self.place
        return on_screen(1e3 * places)

    def map(self, middle):
        """Returns the function from a curve to the pixels of a map."""
        return lambda curve: in_map(self.plane(curve), self.centre, middle)

    def layers(self, values, places):
        """Draws values from 0 to 1 as filled contours; places: functions from curves to pixels. A list of texts."""
        filled = np.pad(np.where(np.isnan(values), -1, values), 1, constant_values=-1.0)
        for _ in range(3):  # extend the skin's values a little, so that contours end at its edge
            near = blur((filled >= 0) * 1.0)
            mean = blur(np.maximum(filled, 0)) / np.maximum(near, 1e-9)
            filled = np.where(filled >= 0, filled, np.where(near > 0, mean, -1))
        out = ["" for _ in places]
        for i in range(LEVELS):
            curves = [c for c in contours(np.minimum(filled - i / LEVELS if i else 9.0, 2 * self.skin)) if len(c) > 6]
            for k, place in enumerate(places):
                if i == 0 and place == self.scene:  # the hand is drawn there
                    continue
                text = "".join(curve_text(place(c)) for c in curves)
                out[k] += f'<path class="c{i}" d="{text}"/>' if text else ""
        return out


def in_map(points, centre, middle):
    x, y = (1e3 * MAP_SCALE * (points - centre)).T
    return np.stack([middle + x, MAP_Y - y], 1)


def follow(moments, rasters):
    """Orders the paths of each moment like those before; returns for each the (path, place in it from 0 to 1)."""
    followed, before = [], None
    for moment, raster in zip(moments, rasters):
        paths = moment.paths
        centres = [np.mean(flat, axis=0) - raster.centre for _, flat in paths]
        if before is None:
            chosen, places = list(range(len(paths))), [0.0] * len(paths)
        else:
            chosen, places, left = [], [], list(range(len(paths)))
            for centre, position in before[:len(paths)]:
                chosen.append(min(left, key=lambda k, c=centre: np.sum((centres[k] - c) ** 2)))
                left.remove(chosen[-1])
                flat = paths[chosen[-1]][1] - raster.centre
                nearest = int(np.argmin(np.sum((flat - position) ** 2, axis=1)))
                places.append((nearest / len(flat) + SHOWN / (SLOWER * 0.02)) % 1)
            chosen += left
            places += [0.0] * len(left)
        followed.append([(paths[k], place) for k, place in zip(chosen, places)])
        before = [(np.mean(p[1], axis=0) - raster.centre, at_place(p[1], place) - raster.centre)
                  for p, place in followed[-1]]
    return followed


def at_place(points, place):
    at = (place % 1) * len(points)
    low = int(at) % len(points)
    return points[low] + (at - int(at)) * (points[(low + 1) % len(points)] - points[low])


def draw_paths(followed, pixels, names, radius):
    """Draws paths, the last part of each focal point's way, and the focal points; pixels: from path to pixels."""
    out = []
    for i, (one, place) in enumerate(followed):
        points = pixels(one)
        tail = np.array([at_place(points, place - 0.16 * k / 10) for k in range(11)])
        x, y = 2 * tail[0]
        name = f"{names}{i}"
        out.append(f'<g class="q">{path(curve_text(points), id=name)}</g>'
                   f'<use href="#{name}" class="l" stroke="{PATHS[i % 4]}"/>'
                   + path(curve_text(tail, closed=False), **{"class": "t"})
                   + f'<circle cx="{x:.0f}" cy="{y:.0f}" r="{radius}" fill="#fff" '
                     f'stroke="{PATHS[i % 4]}" stroke-width="4"/>')
    return "".join(out)


def chart_place(i, count, level):
    left, top, width, height, low, high = CHART
    return left + width * i / (count - 1), top + height * (high - max(level, low)) / (high - low)


def draw_chart(levels):
    left, top, width, height, low, high = CHART
    line = curve_text([chart_place(i, len(levels), level) for i, level in enumerate(levels)], closed=False)
    zero, ten = (top + height * (high - level) / (high - low) for level in (0, -10))
    return (f'<path d="M{left} {zero:.1f}h{width}" class="z"/><path d="M{left} {ten:.1f}h{width}" class="g"/>'
            f'<text x="{left + width}" y="{zero - 6:.0f}" class="n" text-anchor="end">0 dB: threshold of touch</text>'
            f'<text x="{left + width}" y="{ten + 14:.0f}" class="n" text-anchor="end">−10 dB</text>'
            f'<g transform="scale(.5)">{path(line, fill="none", stroke="#9fb0cc", stroke_width=3)}</g>')


def draw_bar(middle, low, high):
    left, step = middle - 48, 96 / LEVELS
    steps = "".join(f'<rect x="{left + step * i:.0f}" y="330" width="{step:.0f}" height="7" class="c{i}"/>'
                    for i in range(LEVELS))
    return (steps + f'<text x="{left - 7}" y="337" class="n" text-anchor="end">{low}</text>'
            f'<text x="{left + 103}" y="337" class="n">{high}</text>')


def style(count):
    colours = "".join(f".c{i}{{fill:{field_colour((i + 0.5) / LEVELS)}}}" for i in range(LEVELS))
    return f"""<style>
.f{{visibility:hidden;animation:f {count * SHOWN:.2f}s step-end infinite}}
@keyframes f{{0%{{visibility:visible}}{100 / count:.4f}%{{visibility:hidden}}100%{{visibility:hidden}}}}
@media(prefers-reduced-motion:reduce){{.f{{animation:none}}#still{{visibility:visible}}}}
{colours}
.s{{mask:url(#m)}}.s path{{fill:#c9d8ff;fill-opacity:.1}}.j{{fill:#c9d8ff;fill-opacity:.3}}
.a ellipse{{fill:#39435a}}.p{{fill:#1d2433;stroke:#39435a;stroke-width:3}}
.h{{opacity:.42;stroke:#ffc9b0;stroke-linecap:round;stroke-linejoin:round}}
.q,.l,.t{{fill:none;stroke-linejoin:round;stroke-linecap:round}}
.q{{stroke:#0b0f18;stroke-width:6;stroke-opacity:.6}}.l{{stroke-width:3}}.t{{stroke:#fff;stroke-width:5}}
.z{{stroke:#e8ecf3;stroke-dasharray:5 4}}.g{{stroke:#39435a}}
text{{fill:#e8ecf3;font:14px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}}
.b{{font-weight:600}}.n{{font-size:12px;fill:#9fb0cc}}
</style>
<filter id="d"><feGaussianBlur stdDeviation="5"/></filter>
<linearGradient id="e" gradientUnits="userSpaceOnUse" x2="0" y1="130" y2="300">
<stop stop-opacity="0"/><stop offset="1" stop-color="#fff"/></linearGradient>
<mask id="m" maskUnits="userSpaceOnUse" x="20" y="130" width="840" height="720">
<rect width="860" height="900" fill="url(#e)"/></mask>"""


def draw_below(transducers, smoke, levels, most):
    """Draws what does not move below the frames."""
    return (f'<rect width="{WIDTH}" height="{HEIGHT}" rx="12" fill="#10141d"/>'
            f'<g transform="scale(.5)">{draw_array(transducers)}{draw_jets(smoke)}</g>'
            + draw_chart(levels)
            + draw_bar(MAPS[0], "0", f"{most:.2f} Pa") + draw_bar(MAPS[1], f"−{-LEAST_DB}", "0 dB"))


def draw_above(seconds):
    """Draws the words, above the frames."""
    texts = [(24, "start", "A hand in four plumes of smoke", f"simulated; {seconds:.0f} s at half speed"),
             (MAPS[0], "middle", "pressure of the smoke", f"4 focal points, {SLOWER} × slower"),
             (MAPS[1], "middle", "felt, by a skin model", "dB above the threshold")]
    words = "".join(f'<text x="{x}" y="34" class="b" text-anchor="{anchor}">{title}</text>'
                    f'<text x="{x}" y="54" class="n" text-anchor="{anchor}">{more}</text>'
                    for x, anchor, title, more in texts)
    return words + f'<text x="24" y="{HEIGHT - 16}" class="n">array of 16 × 16 transducers</text>'


def draw(moments, transducers, seen):
    """Returns the animation as SVG."""
    rasters = [Raster(p.target) for p in seen]
    below, above = prostm.sensation_interval()
    most = max(float(np.nanmax(p.target.pressure)) for p in seen)
    count = len(moments)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">',
           style(count), draw_below(transducers, moments[0].smoke, [p.level for p in seen], most)]
    for i, (moment, sense, raster, ways) in enumerate(zip(moments, seen, rasters, follow(moments, rasters))):
        pressure = raster.layers(sense.target.pressure / most, [raster.scene, raster.map(MAPS[0])])
        felt = raster.layers(np.clip(sense.felt_db / -LEAST_DB + 1, 0, 0.999), [raster.map(MAPS[1])])
        x, y = chart_place(i, count, sense.level)
        level = f"{sense.level:.0f}".replace("-", "−")
        words = f"felt strength {level} dB, ± {max(below, above):.0f} dB"
        first = partial(in_map, centre=raster.centre, middle=MAPS[0])
        out.append(f'<g class="f" id="{"still" if i == count // 4 else f"f{i}"}" '
                   f'style="animation-delay:{i * SHOWN:.2f}s"><g transform="scale(.5)">' + draw_smoke(moment.smoke)
                   + draw_hand(moment.joints) + f'<g opacity=".85">{pressure[0]}</g>'
                   + draw_paths(ways, lambda one: on_screen(1e3 * one[0]), f"s{i}-", 10) + pressure[1]
                   + draw_paths(ways, lambda one, place=first: place(one[1]), f"m{i}-", 8) + felt[0] + "</g>"
                   + f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="#fff"/>'
                   + f'<text x="{CHART[0]}" y="{CHART[1] - 16}" class="b">{words}</text></g>')
    return "\n".join([*out, draw_above(count * UPDATE), "</svg>"]) + "\n"


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        moments, transducers = watch(program, Path(name))
        seen = percepts(program, moments, Path(name))
    Path(sys.argv[2]).write_text(draw(moments, transducers, seen), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
