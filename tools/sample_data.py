#!/usr/bin/env python3
"""Makes the samples in data/: three fields, the recording of a hand, and made-up answers.

usage: sample_data.py PROSTM [FOLDER]

PROSTM is the program; the files are written to FOLDER (default: data). The fields are targets of the scripted hand in
smoke and a drawn picture, the recording is the scripted hand at 50 frames a second. The answers are not from people:
they are drawn at random.
"""

import json
import random
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import h5py
import numpy as np

JOINTS = 26
RECORDED_SECONDS = 8


def record(prostm, folder, scene, seconds):
    """Makes a stepped run of the scripted hand, with a target for each of 50 steps a second."""
    settings, out = folder / "samples.toml", folder / f"{scene}.h5"
    settings.write_text("[pipeline]\nworld_steps_per_plan = 1\n")
    subprocess.run([prostm, "run", "--stepped", "--scene", scene, "--seconds", str(seconds), "--preset", "fast",
                    "--settings", settings, "--record", out], check=True, stdout=subprocess.DEVNULL)
    return out


def strongest(recording):
    """Returns the patch with the largest sum of pressures: pressure, height, cell, origin, pose."""
    with h5py.File(recording) as f:
        target = f["target"]
        shapes = np.stack([target["rows"], target["cols"]], axis=1)
        ends = target["offset"][:] + shapes.prod(axis=1)
        all_pressures = target["pressure"][:]
        sums = [np.nansum(all_pressures[a:b]) for a, b in zip(target["offset"], ends)]
        k = int(np.argmax(sums))
        cells = slice(target["offset"][k], ends[k])
        return {name: target[name][cells].reshape(shapes[k]) for name in ("pressure", "height")} | {
            name: target[name][k] for name in ("cell", "origin", "pose")}


def rows_of(values, digits):
    return [[None if np.isnan(v) else round(float(v), digits) for v in row] for row in values]


def write_field(patch, path):
    pose = patch["pose"]
    height = np.where(np.isnan(patch["pressure"]), np.nan, 1e3 * patch["height"])
    field = {
        "format": "prostm-field/1",
        "cell_mm": round(1e3 * float(patch["cell"]), 6),
        "origin_mm": [round(1e3 * float(v), 6) for v in patch["origin"]],
        "rows": patch["pressure"].shape[0],
        "cols": patch["pressure"].shape[1],
        "pressure": rows_of(patch["pressure"], 5),
        "height_mm": rows_of(height, 2),
        "plane": {"origin_mm": [float(v) for v in 1e3 * pose[:3, 3]], "x": list(pose[:3, 0]), "y": list(pose[:3, 1])},
    }
    rows = [f" {json.dumps(key)}: {json.dumps(value)}" for key, value in field.items()]
    path.write_text("{\n" + ",\n".join(rows) + "\n}\n")


def letter(pixels=60):
    """Draws the letter P in soft strokes, white on black, row 0 on top; 0 to 1."""
    y, x = np.mgrid[0:pixels, 0:pixels] / (pixels - 1)
    stem = np.hypot(x - 0.3, y - np.clip(y, 0.12, 0.88))
    bars = np.hypot(x - np.clip(x, 0.3, 0.52), np.abs(y - 0.31) - 0.19)
    bowl = np.where(x < 0.52, 1.0, np.abs(np.hypot(x - 0.52, y - 0.31) - 0.19))
    distance = np.minimum(np.minimum(stem, bars), bowl)
    return np.clip(1.5 - distance / 0.06, 0.0, 1.0)


def write_png(image, path):
    """Writes an 8-bit greyscale picture."""
    grey = np.round(255 * image).astype(np.uint8)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)
    lines = b"".join(b"\0" + row.tobytes() for row in grey)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 9)) +
                     chunk(b"IEND", b""))


def write_hands(recording, path):
    """Writes a recording's hands in the frame of a tracker at the array's centre: (x, y, z) of T is (x, -z, y) of D."""
    turn = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])  # x, y, z, w: T to D, a quarter turn about x
    lines = [json.dumps({"format": "hand-frames", "version": 1, "units": "m", "source": "prostm's scripted hand"})]
    with h5py.File(recording) as f:
        hand, times = f["hand"], f["frame/time"][:]
        for i in np.flatnonzero(times <= RECORDED_SECONDS):
            hands = []
            for k in np.flatnonzero(hand["side"][i] >= 0):
                p = hand["position"][i, k][:, [0, 2, 1]] * [1, 1, -1]
                q = times_inverse(turn, hand["orientation"][i, k])
                hands.append({"id": int(hand["id"][i, k]), "side": "LR"[hand["side"][i, k]],
                              "p": flat(p, 4), "q": flat(q, 4), "r": flat(hand["radius"][i, k], 4)})
            lines.append(json.dumps({"t": round(float(times[i]), 6), "hands": hands}, separators=(",", ":")))
    path.write_text("\n".join(lines) + "\n")


def times_inverse(turn, q):
    """Returns turn⁻¹ · q, each row x, y, z, w."""
    (ax, ay, az), aw = -turn[:3], turn[3]
    x, y, z, w = q.T
    return np.stack([aw * x + ax * w + ay * z - az * y, aw * y - ax * z + ay * w + az * x,
                     aw * z + ax * y - ay * x + az * w, aw * w - ax * x - ay * y - az * z], axis=1)


def flat(values, digits):
    return [round(float(v), digits) for v in np.ravel(values)]


def write_answers(path):
    """Writes answers of 16 made-up participants, eight with each method. Each has a share of right answers of its own,
    around the method's."""
    draw = random.Random(5)
    scenes = ("one-plume", "four-plumes")
    lines = ["participant,trial,method,scene,question,answer,correct,response_s"]
    for method, letter_of, share in (("am", "A", 0.6), ("pro-stm", "S", 0.76)):
        for person in range(1, 9):
            own = draw.betavariate(6 * share, 6 * (1 - share))
            trials = 4 * [(scene, question) for scene in scenes for question in scenes]
            draw.shuffle(trials)
            for number, (scene, question) in enumerate(trials, 1):
                right = draw.random() < own
                answer = (question == scene) == right
                lines.append(f"{letter_of}{person},{number},{method},{scene},{question},{answer:d},{right:d},"
                             f"{draw.lognormvariate(0.8, 0.4):.2f}")
    path.write_text("\n".join(lines) + "\n")


def main():
    if len(sys.argv) not in (2, 3):
        print("sample_data: give the program, and a folder; see its first lines", file=sys.stderr)
        return 2
    out = Path(sys.argv[2] if len(sys.argv) == 3 else "data")
    out.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        one = record(sys.argv[1], Path(folder), "one-plume", RECORDED_SECONDS + 2)
        four = record(sys.argv[1], Path(folder), "four-plumes", RECORDED_SECONDS + 2)
        np.save(out / "palm.npy", strongest(one)["pressure"].astype(np.float32))
        write_field(strongest(four), out / "four-plumes.json")
        write_hands(one, out / "wave.hands.jsonl")
    write_png(letter(), out / "letter.png")
    write_answers(out / "made-up-answers.csv")
    return 0


if __name__ == "__main__":
    sys.exit(main())
