"""The comparison of two builds: a build equals itself, and differs from one that plans slightly differently."""

import os
import subprocess
from pathlib import Path

import prostm
import pytest

from conftest import ROOT

TOOL = ROOT / "tools" / "same_results.py"


@pytest.fixture
def build(tmp_path):
    """Returns a function that creates a build folder whose program adds options to the given ones."""
    program = Path(os.environ.get("PROSTM", ROOT / "build" / "release" / "prostm"))

    def make(name, *options):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "python").symlink_to(Path(prostm.__file__).resolve().parents[1])
        (folder / "prostm").write_text(f'#!/bin/sh\nexec "{program}" "$@" {" ".join(options)}\n')
        (folder / "prostm").chmod(0o755)
        return folder

    return make


def compare(tmp_path, *builds, seconds=0.8):
    """Returns the exit status, the lines and the errors of a comparison of the scenes only, with plain code."""
    command = (TOOL, *builds, "--seconds", seconds, "--vectors", "none", "--hands", tmp_path)
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, timeout=300)
    return done.returncode, done.stdout.splitlines(), done.stderr


def test_a_build_equals_itself(build, tmp_path):
    status, lines, _ = compare(tmp_path, build("one"), build("other"))
    assert status == 0, lines
    assert [line.split()[-3:] for line in lines[1:-1]] == [["same"] * 3] * 2
    assert lines[-1] == "all the same to the bit"


def test_differing_plans_and_samples_are_found(build, tmp_path):
    status, lines, _ = compare(tmp_path, build("one"), build("other", "--paths 3"))
    assert status == 1
    words = [line.split() for line in lines[1:-1]]
    assert [row[5:8] for row in words] == [["same", "DIFFERS", "DIFFERS"]] * 2
    assert "plan/points," in words[0]
    assert lines[-1] == "NOT the same"


def test_a_run_without_a_plan_compares_nothing(build, tmp_path):
    status, _, error = compare(tmp_path, build("one"), build("other"), seconds=0.2)
    assert status == 2
    assert "nothing is compared" in error


def test_missing_parts_of_a_build_are_reported(tmp_path):
    status, _, error = compare(tmp_path, tmp_path, tmp_path)
    assert status == 2
    assert "has no prostm" in error
