"""prostm selftest: it asks before it plays, fades in, and stores the answers."""

import json
import os
import pty
import select
import signal
import subprocess
import time

import pytest


class Asked:
    """The program on its own terminal."""

    def __init__(self, program, folder, *arguments):
        self.terminal, theirs = pty.openpty()
        self.process = subprocess.Popen([str(program), "selftest", *arguments], cwd=folder, stdin=theirs, stdout=theirs,
                                        stderr=theirs, start_new_session=True)
        os.close(theirs)
        self.text = ""

    def expect(self, words, seconds=60):
        end = time.monotonic() + seconds
        start = len(self.text)
        while words not in self.text[start:]:
            left = end - time.monotonic()
            assert left > 0, f"{words!r} never came: {self.text}"
            if select.select([self.terminal], [], [], left)[0]:
                self.text += os.read(self.terminal, 4096).decode()

    def answer(self, text):
        os.write(self.terminal, (text + "\n").encode())

    def end(self):
        deadline = time.monotonic() + 60
        while self.process.poll() is None:
            assert time.monotonic() < deadline
            if select.select([self.terminal], [], [], 0.05)[0]:
                try:
                    self.text += os.read(self.terminal, 4096).decode()
                except OSError:
                    break
        self.process.wait(timeout=60)
        os.close(self.terminal)
        return self.process.returncode


def result_of(folder, name="test.json"):
    return json.loads((folder / name).read_text())


def test_without_a_terminal_nothing_is_played_unless_requested(refuses):
    refuses("selftest", words=["no terminal", "--yes", "--silent"])


def test_silent_connects_and_draws(prostm, tmp_path):
    done = prostm("selftest", "--silent", "--array", "autd3", "--json", "test.json", "--figure", "array.png")
    assert "simulated autd3" in done.stdout and "249 transducers in 1 unit" in done.stdout
    result = result_of(tmp_path)
    assert result["format"] == "prostm-selftest/1" and result["passed"] and result["figures"] == []
    (unit,) = result["units"]
    assert unit["transducers"] == 249 and unit["normal"] == [0, 0, 1]
    assert unit["transducer_0_mm"] == pytest.approx([-86.36, -66.04, 0])
    assert (tmp_path / "array.png").stat().st_size > 10_000
    assert result["blocks"] > 0


def test_yes_plays_every_figure_within_the_limits(prostm, tmp_path):
    prostm("selftest", "--yes", "--seconds", "0.3", "--json", "test.json")
    result = result_of(tmp_path)
    assert [figure["played"] for figure in result["figures"]] == [True, True]
    assert all(figure["felt"] is None for figure in result["figures"])
    assert result["limited_samples"] == 0 and result["passed"] and not result["stopped"]


def test_caps_hold(prostm, tmp_path):
    (tmp_path / "low.toml").write_text("[safety]\nacoustic_pressure = 1000\n")
    prostm("selftest", "--yes", "--seconds", "0.3", "--settings", "low.toml", "--json", "test.json")
    safety = result_of(tmp_path)["safety"]
    assert safety["acoustic_pressure"] > 0, "some samples were lowered"
    assert 900 < safety["acoustic_high_pa"] <= 1001


def test_each_unit_of_several_is_played_alone(prostm, tmp_path):
    pitch, cols, rows = 10.16, 18, 14
    places = [(pitch * (x - (cols - 1) / 2), pitch * (y - (rows - 1) / 2))
              for y in range(rows) for x in range(cols) if not (y == 1 and x in (1, 2, 16))]
    positions = [[x + shift, y, 0] for shift in (-97, 97) for x, y in places]
    array = {"format": "prostm-array/1", "name": "two", "frequency_hz": 40000, "radius_mm": 4.5,
             "directivity": "t4010a1", "amplitude_pa_m": 4.386, "transducers_mm": positions}
    (tmp_path / "two.json").write_text(json.dumps(array))
    prostm("selftest", "--yes", "--seconds", "0.2", "--array", "two.json", "--json", "test.json")
    result = result_of(tmp_path)
    assert [unit["first_transducer"] for unit in result["units"]] == [0, 249]
    assert [figure["name"] for figure in result["figures"][2:]] == ["a point over unit 1 of 2", "a point over unit 2 of 2"]


def test_answers_are_stored(program, tmp_path):
    asked = Asked(program, tmp_path, "--seconds", "0.3", "--json", "test.json")
    asked.expect("Play it? [Y/n/q]")
    asked.answer("")
    asked.expect("Can you feel it? [y/n]")
    asked.answer("perhaps")
    asked.expect("Can you feel it? [y/n]")
    asked.answer("y")
    asked.expect("Play it? [Y/n/q]")
    asked.answer("Y")
    asked.expect("Can you feel it? [y/n]")
    asked.answer("No")
    assert asked.end() == 1, asked.text
    result = result_of(tmp_path)
    assert [figure["felt"] for figure in result["figures"]] == [True, False] and not result["passed"]


def test_a_figure_can_be_skipped_or_muted_and_the_test_ended(program, tmp_path):
    asked = Asked(program, tmp_path, "--seconds", "60", "--json", "test.json")
    asked.expect("Play it? [Y/n/q]")
    asked.answer("n")
    asked.expect("Play it? [Y/n/q]")
    asked.answer("y")
    time.sleep(0.5)
    start = time.monotonic()
    asked.answer("")  # mutes
    asked.expect("Can you feel it? [y/n]")
    assert time.monotonic() - start < 5
    asked.answer("y")
    assert asked.end() == 0, asked.text
    assert [figure["played"] for figure in result_of(tmp_path)["figures"]] == [False, True]
    asked = Asked(program, tmp_path, "--json", "other.json")
    asked.expect("Play it? [Y/n/q]")
    asked.answer("q")
    assert asked.end() == 0
    assert result_of(tmp_path, "other.json")["figures"] == [
        {"name": "a point that moves slowly to and fro along x, 60 mm", "played": False, "felt": None}]


@pytest.mark.parametrize("moment", ["question", "figure"])
def test_ctrl_c_mutes_and_keeps_the_result(program, tmp_path, moment):
    asked = Asked(program, tmp_path, "--seconds", "60", "--json", "test.json")
    asked.expect("Play it? [Y/n/q]")
    if moment == "figure":
        asked.answer("y")
        time.sleep(0.5)
    asked.process.send_signal(signal.SIGINT)
    assert asked.end() == 130, asked.text
    result = result_of(tmp_path)
    assert result["stopped"] and [figure["felt"] for figure in result["figures"]] == [None]


@pytest.mark.parametrize("args, words", [
    (["--seconds", "0"], ["--seconds 0", "0.2 to 60"]),
    (["--height-mm", "10"], ["--height-mm 10", "50 to 500"]),
    (["--level", "2"], ["--level 2", "0.05 to 1"]),
    (["--level", "nan"], ["--level nan"]),
    (["--device", "toaster"], ["toaster"]),
    (["--array", "none.json"], ["none.json"]),
    (["--figure", "array.gif"], [".png"]),
])
def test_bad_options(refuses, args, words):
    refuses("selftest", "--yes", *args, words=words)
