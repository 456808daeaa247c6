"""Progress of long work on a terminal, and its interruption by Ctrl-C."""

import os
import pty
import re
import select
import signal
import subprocess
import time

import numpy as np
import pytest


def ring(path, side, edge_mm):
    """Writes a ring of pressure with a radius of 22 mm."""
    x = (np.arange(side) - side / 2 + 0.5) * edge_mm
    np.save(path, np.exp(-((np.hypot(*np.meshgrid(x, x)) - 22) / 5) ** 2))


class OnTerminal:
    """A command whose standard error is a terminal."""

    def __init__(self, program, folder, *arguments, term="xterm"):
        self.master, end = pty.openpty()
        self.process = subprocess.Popen([str(program), *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=end, env={**os.environ, "TERM": term})
        os.close(end)
        self.shown = ""

    def read(self):
        """Appends the next output to `shown`; false at the end."""
        try:
            data = os.read(self.master, 1 << 16)
        except OSError:
            data = b""
        self.shown += data.decode()
        return bool(data)

    def crawl_until(self, pattern):
        """Suspends the process for two seconds at a time, so that its stages take long on any machine."""
        while not re.search(pattern, self.shown):
            assert self.process.poll() is None, f"ended without {pattern}: {self.shown}"
            self.process.send_signal(signal.SIGSTOP)
            time.sleep(2.2)
            self.process.send_signal(signal.SIGCONT)
            self.read_for(0.4)

    def read_for(self, seconds):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select.select([self.master], [], [], left)[0] and not self.read():
                return

    def end(self):
        while self.read():
            pass
        os.close(self.master)
        return self.process.wait(timeout=60)


@pytest.mark.long
def test_stages_show_their_count_or_their_time(program, tmp_path):
    ring(tmp_path / "ring.npy", 400, 0.35)
    planning = OnTerminal(program, tmp_path, "plan", "ring.npy", "--cell-mm", "0.35", "--json", "plan.json")
    assert planning.end() == 0
    assert re.search(r"\rscoring the controls  \d+ of \d+ fields ", planning.shown)
    assert planning.shown.endswith("\r\033[K")
    field = OnTerminal(program, tmp_path, "field", "plan.json", "--field", "ring.npy", "--cell-mm", "0.35", "--json",
                       "field.json")
    field.crawl_until(r"\rcomputing the pressure on the skin  \d+ s ")
    assert field.end() == 0
    assert field.shown.endswith("\r\033[K")


@pytest.mark.long
def test_ctrl_c_ends_long_work_without_files(program, tmp_path):
    ring(tmp_path / "ring.npy", 400, 0.35)
    subprocess.run([str(program), "plan", "ring.npy", "--cell-mm", "0.35", "--json", "plan.json"], cwd=tmp_path, check=True,
                   stdout=subprocess.DEVNULL)
    before = sorted(tmp_path.iterdir())
    field = OnTerminal(program, tmp_path, "field", "plan.json", "--field", "ring.npy", "--cell-mm", "0.35", "--json",
                       "field.json", "--figure", "field.png")
    field.crawl_until("computing the pressure")
    field.process.send_signal(signal.SIGINT)
    assert field.end() == -signal.SIGINT
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("term", ["dumb", ""])
def test_a_terminal_without_erase_gets_no_progress(program, tmp_path, term):
    ring(tmp_path / "ring.npy", 200, 0.7)
    planning = OnTerminal(program, tmp_path, "plan", "ring.npy", "--cell-mm", "0.7", term=term)
    assert planning.end() == 0
    assert "\r" not in planning.shown.replace("\r\n", "\n") and "\033" not in planning.shown
