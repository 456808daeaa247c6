#!/usr/bin/python3
"""Compares the results of two builds bit by bit: targets, plans, and the samples of their emission at 40 kHz.

usage: same_results.py OTHER_BUILD [THIS_BUILD] [--seconds S] [--hands FOLDER] [--vectors NAME…]

A build is a folder like build/release (the default of THIS_BUILD), with the program and its Python module. Both builds
play the scripted hand in two scenes, and each recorded hand of FOLDER (default: ../shared/data/hands) in one of them,
stepped, with each set of vector instructions of this processor, and without any. The recordings of these runs are
compared. The samples come from the emitter of each build's Python module, which plays the recorded plans: they are
handed over at the times of the run, a block at a time. Some of the recording's own counters must agree with that
emission. Exits 1 if anything differs, and 2 if nothing could be compared.

./run same COMMIT builds a commit and this tree, and calls this script.
"""

import argparse
import ctypes
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SCENES = ("one-plume", "four-plumes")
RECORDED_IN = "four-plumes"
TARGETS = ("frame", "hand", "target")
PLANS = ("plan",)
TAKE_TIME = ("plan/stage_time",)  # measured times, which differ between runs
FULL_SCALE = 0.7  # [Pa], fixed, so that the recording's settings suffice for the emission
RATE, BLOCK = 40e3, 40


class Failed(Exception):
    """A program failed; the text names it and the cause."""


def call(command, environment):
    """Returns the output of a program that must succeed."""
    words = [str(part) for part in command]
    done = subprocess.run(words, env={**os.environ, **environment}, stdin=subprocess.DEVNULL, text=True,
                          capture_output=True)
    if done.returncode != 0:
        raise Failed(f"{' '.join(words)}: {done.stderr.strip() or done.returncode}")
    return done.stdout


def target_frame(prostm, file, frame):
    """Returns the target of one recorded frame."""
    target, patches = file["target"], []
    first = file["frame/first_patch"][frame]
    for patch in range(first, first + file["frame/patches"][frame]):
        shape = (int(target["rows"][patch]), int(target["cols"][patch]))
        cells = slice(int(target["offset"][patch]), int(target["offset"][patch]) + shape[0] * shape[1])
        patches.append(prostm.TargetField(target["pressure"][cells].reshape(shape), cell=float(target["cell"][patch]),
                                          origin=target["origin"][patch], X_DP=target["pose"][patch],
                                          height=target["height"][cells].reshape(shape)))
    return prostm.TargetFrame(patches)


def recorded_plan(prostm, file, frame):
    """Returns the plan of paths of one recorded frame; None if it has no plan."""
    plan, paths = file["plan"], []
    for path in range(plan["paths"][frame]):
        points = plan["samples"][frame, path]
        paths.append(prostm.FocalPath(plan["points"][frame, path, :points], plan["pressure"][frame, path, :points],
                                      speed=float(plan["speed"][frame, path]), patch=int(plan["patch"][frame, path])))
    return prostm.Plan(paths) if paths else None


def emission(recording):
    """Returns digest and counters of the samples of the recorded plans, by the module that this process imports."""
    import prostm
    digest = hashlib.sha256()
    with h5py.File(recording) as file:
        emitter = prostm.PathEmitter(sample_rate=RATE, **json.loads(file.attrs["settings"])["emit"])
        times, sample = file["frame/time"][:], 0
        for frame, time in enumerate(times):
            while sample + BLOCK <= round(time * RATE):
                for part in emitter.fill(sample, BLOCK):
                    digest.update(np.ascontiguousarray(part).tobytes())
                sample += BLOCK
            plan = recorded_plan(prostm, file, frame)
            if plan is None:
                emitter.lose()
            else:
                lifted = prostm.lift(plan, target_frame(prostm, file, frame))
                lifted.id = frame + 1
                emitter.submit(lifted)
    stats = emitter.stats()
    return {"digest": digest.hexdigest(), "samples": stats.samples, "saturated": stats.saturated}


class Build:
    """A folder with the program and its Python module."""

    def __init__(self, folder):
        self.folder = Path(folder).resolve()
        for needed in ("prostm", "python"):
            if not (self.folder / needed).exists():
                raise Failed(f"{self.folder} has no {needed}: build it with -DPROSTM_PYTHON=ON")

    def play(self, case, seconds, settings, environment, out):
        """Plays one case into a recording. Returns the result of emission() for its plans."""
        scene, hand = case
        call([self.folder / "prostm", "run", "--stepped", "--scene", scene, "--hand", hand, "--seconds", seconds,
              "--settings", settings, "--record", out], environment)
        return json.loads(call([sys.executable, __file__, "--emission", out],
                               {**environment, "PYTHONPATH": str(self.folder / "python")}))


def contents(file, groups):
    """Returns every dataset of the groups, as type, shape and bytes."""
    found = {}
    for group in groups:
        for name, data in file[group].items():
            if f"{group}/{name}" not in TAKE_TIME:
                found[f"{group}/{name}"] = (data.dtype.str, data.shape, data[()].tobytes())
    return found


def differences(files, groups):
    """Returns the names of the datasets that differ between the files."""
    one, other = (contents(file, groups) for file in files)
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))


def compare(builds, case, seconds, environment, folder):
    """Returns one line of the table, and whether all results are the same."""
    settings = folder / "settings.toml"
    settings.write_text(f"[emit]\nfull_scale_pressure = {FULL_SCALE}\n")
    recordings = [folder / f"{number}.h5" for number in range(2)]
    with ThreadPoolExecutor() as pool:
        emissions = list(pool.map(lambda build, out: build.play(case, seconds, settings, environment, out), builds,
                                  recordings))
    with h5py.File(recordings[0]) as one, h5py.File(recordings[1]) as other:
        plans = int(np.count_nonzero(one["plan/paths"][:] > 0))
        if plans == 0:
            raise Failed(f"{case[1]} in {case[0]} made no plan: nothing is compared")
        for file, made in zip((one, other), emissions):
            check_replay(file, made)
        found = [differences((one, other), TARGETS), differences((one, other), PLANS),
                 [] if emissions[0] == emissions[1] else ["emission"]]
    words = [f"{'DIFFERS' if names else 'same':<8}" for names in found]
    names = ", ".join(name for part in found for name in part)
    return f"{plans:>6} {emissions[0]['samples']:>8}  {' '.join(words)} {names}".rstrip(), not names


def check_replay(file, made):
    """Checks that the module's emission agrees with the run's own counters."""
    summary = json.loads(file.attrs["summary"])
    counted = [name for name in ("samples", "saturated") if name in summary]
    if not counted:
        raise Failed("the run's summary has no counter to compare with the emission of its plans")
    for name in counted:
        if summary[name] != made[name]:
            raise Failed(f"the run counts {summary[name]} {name}, but the emission of its plans {made[name]}")


def vector_sets(folder):
    """Returns the library that limits a program, and the names that it knows on this processor."""
    library = folder / "only_vectors.so"
    source = Path(__file__).with_name("only_vectors.cpp")
    call(["g++", "-std=c++20", "-shared", "-fPIC", source, "-o", library, "-lhwy"], {})
    names = ctypes.create_string_buffer(256)
    ctypes.CDLL(str(library)).list_vectors(names, len(names))
    return library, names.value.decode().split() + ["none"]


def recorded_hands(folder):
    hands = sorted(folder.glob("*.hands.jsonl"))
    if not hands:
        print(f"same_results: no recorded hands: they are not part of the project, and {folder} contains none",
              file=sys.stderr)
    return hands


def compare_all(given):
    builds = [Build(given.other), Build(given.this)]
    cases = [(scene, "scripted") for scene in SCENES] + [(RECORDED_IN, hand) for hand in recorded_hands(given.hands)]
    all_same = True
    with tempfile.TemporaryDirectory(prefix="same_results.") as scratch:
        folder = Path(scratch)
        library, known = vector_sets(folder)
        print(f"{'hand':<24} {'scene':<12} {'vectors':<8} {'plans':>6} {'samples':>8}  targets  plans    samples")
        for vectors in given.vectors or known:
            environment = {"LD_PRELOAD": str(library), "ONLY_VECTORS": vectors}
            for case in cases:
                line, same = compare(builds, case, given.seconds, environment, folder)
                name = Path(case[1]).name.removesuffix(".hands.jsonl")
                print(f"{name:<24} {case[0]:<12} {vectors:<8} {line}", flush=True)
                all_same = all_same and same
    print("all the same to the bit" if all_same else "NOT the same")
    return 0 if all_same else 1


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--emission":
        print(json.dumps(emission(sys.argv[2])))
        return 0
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("other", metavar="OTHER_BUILD")
    parser.add_argument("this", metavar="THIS_BUILD", nargs="?", default=ROOT / "build" / "release")
    parser.add_argument("--seconds", type=float, default=1.2, help="duration of each run [s] (default: 1.2)")
    parser.add_argument("--hands", type=Path, default=ROOT.parent / "shared" / "data" / "hands")
    parser.add_argument("--vectors", nargs="+", metavar="NAME", help="only these, e.g. AVX2 none")
    try:
        return compare_all(parser.parse_args())
    except Failed as error:
        print(f"same_results: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
