"""Shared fixtures of the module's tests: the program to compare with, and fields."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import prostm
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/support"))  # shared by the tests of the program and of the module


def blobs(rows=24, cols=30, cell=5.0):
    """Returns two bumps of pressure on skin with holes: (rows, cols), NaN = no skin; cell in mm."""
    y, x = np.mgrid[0:rows, 0:cols] * cell
    p = np.exp(-((x - 60) ** 2 + (y - 60) ** 2) / (2 * 22.0**2))
    p += 0.7 * np.exp(-((x - 100) ** 2 + (y - 40) ** 2) / (2 * 12.0**2))
    p[:, :2] = np.nan
    p[0, 20:] = np.nan
    return p


@pytest.fixture
def pressure():
    return blobs()


@pytest.fixture
def field():
    return prostm.TargetField(blobs(), cell_mm=5)


@pytest.fixture(scope="session")
def program_file():
    """Returns the path of the program in the environment variable PROSTM."""
    path = Path(os.environ.get("PROSTM", ROOT / "build" / "release" / "prostm"))
    assert path.is_file(), f"PROSTM names no program: {path}"
    return path


@pytest.fixture(scope="session")
def program(program_file):
    """Returns a function that runs `prostm ARGUMENTS…`."""

    def run(*arguments, status=0):
        result = subprocess.run([str(program_file), *map(str, arguments)], text=True, capture_output=True, timeout=300,
                                stdin=subprocess.DEVNULL)
        assert result.returncode == status, result.stderr
        return result

    return run


def shared_file(name):
    """Returns a file of ../shared, which is not part of the project; skips the test if it is missing."""
    path = ROOT.parent / "shared" / name
    if not path.exists():
        pytest.skip(f"needs {name} in ../shared, which is not part of the project")
    return path
