#!/usr/bin/python3
"""Tests whether this build is slower than another: runs both in turn, A B A B …, and compares the p50 of every time.

usage: compare_benches.py OTHER_BUILD THIS_BUILD [NAME…] [--rounds N] [--bound PERCENT] [--json FILE]

NAME is a benchmark, NAME_bench in the build folders, or "stages": the stages' times in a stepped run of the program.
The default is the quick ones: stages, planner, contact and latency. Rows are matched by their names; rows that only one
build has are listed. In each round a row gives the ratio of this build's p50 to the other's; the median over the rounds
counts. The noise of this median is estimated from the differences between rounds of the same build. Rows slower than
the bound are marked; rows slower than the bound plus the noise make the script exit 1.

./run bench --against COMMIT builds a commit and this tree, and calls this script.
"""

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

QUICK = ["stages", "planner", "contact", "latency"]
TIMES = ("ns", "us", "ms", "s")  # units of compared rows; ./run same checks the others
SCENES = ("one-plume", "four-plumes")
LEAST_ROUNDS = 3


class Failed(Exception):
    """A program failed; the text names it and the cause."""


def call(*command):
    words = [str(word) for word in command]
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, cwd=Path(__file__).parents[1])
    if done.returncode != 0:
        raise Failed(f"{' '.join(words)}: {done.stderr.strip() or done.returncode}")


def stages(build, folder):
    """Returns name -> p50 of the stages of a run in each scene [ms]."""
    times = {}
    for scene in SCENES:
        out = folder / "run.json"
        call(build / "prostm", "run", "--stepped", "--scene", scene, "--seconds", 4, "--json", out)
        for stage, summary in json.loads(out.read_text())["stage_ms"].items():
            if summary["p50"] > 0:
                # in older builds the world's stage is called fluid
                times[f"{scene}: {stage.replace('fluid', 'world')}"] = summary["p50"]
    return times


def options_of(name, folder):
    """Returns the options that make a long benchmark quick."""
    if name == "planner":
        return ["--frames", 10, "--seeds", 1, folder / "four-plumes.h5"]
    if name == "latency":
        return ["--hand", "scripted", "--seconds", 3, "--rounds", 1]
    return []


def measure(build, name, folder):
    """Returns name -> p50 of every time that a benchmark reports."""
    if name == "stages":
        return stages(build, folder)
    out = folder / "rows.json"
    call(build / f"{name}_bench", *options_of(name, folder), "--json", out)
    return {row["name"]: row["p50"] for row in json.loads(out.read_text()) if row["unit"] in TIMES and row["p50"] > 0}


def noise_of(builds):
    """Returns the noise of the median ratio of two builds over the rounds, as a share: twice its standard deviation,
    estimated from the ratios of consecutive rounds of each build."""
    steps = [abs(math.log(after / before)) for rounds in builds for before, after in zip(rounds, rounds[1:])]
    deviation = 1.4826 * statistics.median(steps)
    return 2.0 * 1.2533 * deviation / math.sqrt(len(builds[0]))


def compare(name, other, this, bound):
    """Returns a row's figures; `other` and `this` are its times in each round."""
    ratio, noise = statistics.median(b / a for a, b in zip(other, this)), noise_of((other, this))
    slower = ratio > 1.0 + bound
    return {"name": name, "other_p50": statistics.median(other), "this_p50": statistics.median(this), "ratio": ratio,
            "noise": noise, "verdict": "SLOWER" if ratio > 1.0 + bound + noise else "slower?" if slower else ""}


def run_rounds(builds, names, rounds, folder):
    """Returns for each build a list of rounds, each name -> p50."""
    found = ([], [])
    for count in range(rounds):
        if sys.stderr.isatty():
            print(f"\rround {count + 1} of {rounds}", end="", file=sys.stderr)
        for build, results in zip(builds, found):
            times = {}
            for name in names:
                times.update({f"{name}: {row}": value for row, value in measure(build, name, folder).items()})
            results.append(times)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return found


def compare_all(given):
    builds = [Path(folder).resolve() for folder in (given.other, given.this)]
    with tempfile.TemporaryDirectory(prefix="compare_benches.") as scratch:
        folder = Path(scratch)
        if "planner" in given.names:
            # both builds read the same recording
            call(builds[1] / "prostm", "capture", "--scene", "four-plumes", "--frames", 40, "--out",
                 folder / "four-plumes.h5")
        other, this = run_rounds(builds, given.names, given.rounds, folder)
    ours, theirs = (set.intersection(*(set(times) for times in rounds)) for rounds in (this, other))
    rows = [compare(name, [times[name] for times in other], [times[name] for times in this], given.bound / 100.0)
            for name in this[0] if name in ours & theirs]
    if not rows:
        raise Failed("no row is in both builds")
    print(f"{'p50 of ' + str(given.rounds) + ' rounds':<56} {'other':>10} {'this':>10} {'ratio':>7} {'noise':>7}")
    for row in rows:
        print(f"{row['name']:<56} {row['other_p50']:>10.4g} {row['this_p50']:>10.4g} {row['ratio']:>7.3f} "
              f"{100.0 * row['noise']:>5.1f} %  {row['verdict']}".rstrip())
    for name in sorted(ours ^ theirs):
        print(f"{name:<56} only in {'this build' if name in ours else 'the other build'}")
    if given.json:
        Path(given.json).write_text(json.dumps(rows, indent=1) + "\n")
    slower = [row["name"] for row in rows if row["verdict"] == "SLOWER"]
    print(f"{len(slower)} of {len(rows)} rows are slower by more than {given.bound:g} % and the noise")
    return 1 if slower else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("other", metavar="OTHER_BUILD")
    parser.add_argument("this", metavar="THIS_BUILD")
    parser.add_argument("names", metavar="NAME", nargs="*", help=f"default: {' '.join(QUICK)}")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--bound", type=float, default=3.0, metavar="PERCENT", help="default: 3")
    parser.add_argument("--json", metavar="FILE", help="write the rows")
    given = parser.parse_intermixed_args()
    given.names = given.names or QUICK
    if given.rounds < LEAST_ROUNDS:
        parser.error(f"--rounds {given.rounds} must be at least {LEAST_ROUNDS}")
    try:
        return compare_all(given)
    except Failed as error:
        print(f"compare_benches: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
