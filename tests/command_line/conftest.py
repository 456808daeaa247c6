"""Shared fixtures of the command line's tests: the program, a way to run it, and markers."""

import os
import random
import socket
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/support"))  # shared by the tests of the program and of the module

# a protocol of few short trials, whose smoke is coarse
SHORT = """
[training]
seconds = 0
[trials]
repeats = 1
rest = 0.1
settle = 0.5
gate = "off"
[scene.one-plume]
question = "One?"
[scene.four-plumes]
question = "Four?"
[method.am.pipeline]
method = "am"
[method.am.fluid]
cells = 32
"""


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "realtime: needs the speed or the little memory of a release build; left out under sanitizers")
    config.addinivalue_line(
        "markers", "long: takes long under sanitizers, which leave it out: other tests run the same code")


@pytest.fixture(scope="session")
def program():
    """Returns the path of the program under test, from the environment variable PROSTM."""
    path = Path(os.environ.get("PROSTM", ROOT / "build" / "release" / "prostm"))
    assert path.is_file(), f"PROSTM names no program: {path}"
    return path


@pytest.fixture
def prostm(program, tmp_path):
    """Returns a function that runs `prostm ARGUMENTS…` in an empty folder and returns its result with text output."""

    def run(*arguments, status=0, timeout=300):
        result = subprocess.run([str(program), *map(str, arguments)], cwd=tmp_path, text=True,
                                stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout)
        assert result.returncode == status, f"exit {result.returncode}\n{result.stdout}\n{result.stderr}"
        return result

    return run


@pytest.fixture
def refuses(prostm):
    """Returns a check that `prostm ARGUMENTS…` exits 2 with one sentence on stderr that contains all of `words`."""

    def check(*arguments, words=()):
        result = prostm(*arguments, status=2)
        assert result.stdout == ""
        lines = result.stderr.splitlines()
        assert len(lines) == 1, result.stderr
        for word in words:
            assert word in lines[0]
        return lines[0]

    return check


def free_port():
    """Returns a port that no program uses. It is not one of those that the system gives to clients, or a client that
    tries to connect before the server listens could get the same port, connect to itself and keep the port."""
    while True:
        port = random.randrange(20_000, 32_000)
        with socket.socket() as tcp, socket.socket(type=socket.SOCK_DGRAM) as udp:
            try:
                tcp.bind(("127.0.0.1", port))
                udp.bind(("127.0.0.1", port))
                return port
            except OSError:
                continue


def shared_file(name):
    """Returns a file of ../shared, which is not part of the project; skips the test if it is missing."""
    path = ROOT.parent / "shared" / name
    if not path.exists():
        pytest.skip(f"needs {name} in ../shared, which is not part of the project")
    return path
