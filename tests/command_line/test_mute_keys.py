"""Terminal keys during a run: they mute, and the terminal is restored afterwards, however the run ends."""

import os
import pty
import signal
import subprocess
import termios
import time

import pytest


class Terminal:
    """A run in the foreground of its own terminal."""

    def __init__(self, program, folder, *arguments):
        self.master, self.slave = pty.openpty()
        self.before = termios.tcgetattr(self.slave)

        def take_terminal():
            os.setsid()
            import fcntl
            fcntl.ioctl(self.slave, termios.TIOCSCTTY, 0)

        self.run = subprocess.Popen(
            [str(program), "run", "--grid", "32", "--seconds", "600", *arguments], cwd=folder, stdin=self.slave,
            stdout=self.slave, stderr=subprocess.DEVNULL, preexec_fn=take_terminal)
        self.seen = ""

    def wait_for(self, words, seconds=30):
        end = time.monotonic() + seconds
        while words not in self.seen:
            assert time.monotonic() < end, f"never said {words!r}:\n{self.seen}"
            os.set_blocking(self.master, False)
            try:
                self.seen += os.read(self.master, 4096).decode()
            except BlockingIOError:
                time.sleep(0.02)

    def press(self, key):
        self.seen = ""
        os.write(self.master, key.encode())

    def echoes(self):
        return bool(termios.tcgetattr(self.slave)[3] & termios.ECHO)

    def is_as_before(self):
        return termios.tcgetattr(self.slave) == self.before

    def close(self):
        if self.run.poll() is None:
            self.run.kill()
        self.run.wait(timeout=30)
        os.close(self.master)
        os.close(self.slave)


@pytest.fixture
def terminal(program, tmp_path):
    opened = Terminal(program, tmp_path)
    yield opened
    opened.close()


# a terminal sends characters: those at M's place on Cyrillic, Greek, Hebrew, Arabic and Thai keyboards also mute
@pytest.mark.parametrize("key", ["m", "M", " ", "ь", "Ь", "μ", "צ", "ة", "ท", "ｍ"])
def test_a_key_mutes_and_unmutes(terminal, key):
    terminal.wait_for("Keys: m or space mutes the array")
    assert not terminal.echoes()
    terminal.press(key)
    terminal.wait_for("The array is muted.")
    terminal.press(key)
    terminal.wait_for("The array is not muted any more.")
    terminal.run.send_signal(signal.SIGINT)
    terminal.wait_for("The run: one-plume")
    assert terminal.run.wait(timeout=30) == 130
    assert terminal.is_as_before()


def test_keys_without_a_character_do_not_mute(terminal):
    """The sequences of Enter on the keypad, of a mouse and of Alt-M contain an M."""
    terminal.wait_for("Keys: ")
    terminal.press("\x1bOM\x1b[M\x1b[1;2M\x1bm")
    terminal.press("ф\xff\x1b[C")
    terminal.press("m")
    terminal.wait_for("The array is muted.")
    assert terminal.seen.count("The array is") == 1


def test_ctrl_c_is_still_a_signal(terminal):
    terminal.wait_for("Keys: ")
    os.write(terminal.master, b"\x03")
    terminal.wait_for("The run: one-plume")
    assert terminal.run.wait(timeout=30) == 130
    assert terminal.is_as_before()


# a sanitizer's own SIGSEGV handler stays in place, and does not restore the terminal
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", pytest.param("SIGSEGV", marks=pytest.mark.realtime), "SIGABRT"])
def test_the_terminal_is_restored_after_a_signal(terminal, name):
    terminal.wait_for("Keys: ")
    assert not terminal.is_as_before()
    terminal.run.send_signal(getattr(signal, name))
    status = terminal.run.wait(timeout=30)
    # a fault ends the program as it would without key handling; a sanitizer may respond in its own way
    assert status in ({"SIGTERM": [143], "SIGHUP": [129]}.get(name) or [-getattr(signal, name), 1])
    assert terminal.is_as_before()


def test_without_a_terminal_there_are_no_keys(prostm):
    assert "Keys:" not in prostm("run", "--grid", "32", "--seconds", "0.5").stdout
