"""prostm run --view: its options, and runs that pages and signals end."""

import json
import signal
import socket
import subprocess
import urllib.error
import urllib.request

import pytest

from page_client import numbers, page_says
from waiting import wait_for


def start(program, folder, *arguments, port="0"):
    """Starts a run with a page, on any free port by default; returns the process and the page's address."""
    process = subprocess.Popen([str(program), "run", "--view", "--view-port", port, "--grid", "32", *arguments], cwd=folder,
                               text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    line = process.stdout.readline()
    assert line.startswith("page: http://127.0.0.1:"), line + process.stderr.read()
    address = line.split()[1]
    wait_for(lambda: numbers(address)["run"]["world_steps"] > 0)
    return process, address


def end(process):
    """Sends Ctrl-C; returns the exit status and the remaining output."""
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    return process.returncode, out


@pytest.mark.parametrize("arguments, words", [
    (["--stay"], ["--stay", "--view"]),
    (["--view-port", "0"], ["--view-port", "--view"]),
    (["--view", "--stepped"], ["--view", "real time"]),
    (["--view", "--as-fast-as-possible"], ["--view", "real time"]),
    (["--view", "--view-port", "70000"], ["70000", "65535"]),
    (["--view", "--view-address", "localhost"], ["localhost", "127.0.0.1"]),
    (["--view", "--view-host", "http://lab"], ['--view-host "http://lab"', "without http://"]),
    (["--view", "--view-host", "192.168.1.7"], ["--view-host", "addresses need no name"]),
])
def test_bad_options_are_refused_in_a_sentence(refuses, arguments, words):
    refuses("run", "--seconds", "1", *arguments, words=words)


def test_a_port_in_use_is_refused_in_a_sentence(refuses):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        refuses("run", "--seconds", "1", "--view", "--view-port", str(port), words=[str(port), "in use"])


def test_listens_on_this_machine_only(program, tmp_path):
    process, address = start(program, tmp_path)
    try:
        assert numbers(address)["sequence"] >= 1
        port = int(address.rstrip("/").rsplit(":", 1)[1])
        # 127.0.0.2 also belongs to this machine, but is not the requested address
        with pytest.raises(OSError):
            socket.create_connection(("127.0.0.2", port), timeout=5)
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(urllib.request.Request(address, headers={"Host": "elsewhere.example"}), timeout=60)
        assert refused.value.code == 403
    finally:
        status, _ = end(process)
    assert status == 130


def test_an_undisturbed_run_ends_completely(program, tmp_path):
    process, _ = start(program, tmp_path, "--seconds", "600", "--json", "summary.json", "--figure", "run.png", "--hand", "page")
    process.send_signal(signal.SIGTERM)
    out, errors = process.communicate(timeout=60)
    assert process.returncode == 143 and errors == ""
    assert "no picture was drawn in run.png: no pressure reached a hand" in out
    assert json.loads((tmp_path / "summary.json").read_text())["stopped"] is True


def test_a_run_paused_by_a_page_that_left_ends(program, tmp_path):
    process, address = start(program, tmp_path, "--seconds", "4", "--json", "summary.json")
    with page_says(address, {"type": "transport", "do": "pause"}):
        wait_for(lambda: numbers(address)["run"]["flags"] & 1)
    out, errors = process.communicate(timeout=60)
    assert process.returncode == 0 and errors == ""
    assert out.startswith("No page is connected any more, so the paused run resumes, for ")
    assert json.loads((tmp_path / "summary.json").read_text())["seconds"] == pytest.approx(4.0, abs=0.05)


def test_stays_open_after_its_duration(program, tmp_path):
    process, address = start(program, tmp_path, "--seconds", "2", "--stay", "--json", "summary.json")
    wait_for(lambda: (tmp_path / "summary.json").exists())
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["stopped"] is False and summary["seconds"] == pytest.approx(2.0, abs=0.1)
    before = numbers(address)["run"]["world_steps"]
    wait_for(lambda: numbers(address)["run"]["world_steps"] > before + 10)
    status, out = end(process)
    assert status == 0
    assert "continues at " + address in out


def test_the_same_port_can_be_reused_at_once(program, tmp_path):
    process, address = start(program, tmp_path)
    port = address.rstrip("/").rsplit(":", 1)[1]
    numbers(address)
    assert end(process)[0] == 130
    process, again = start(program, tmp_path, port=port)
    assert again == address
    numbers(again)
    end(process)
