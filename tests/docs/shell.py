"""Runs the commands of a document as written, and compares their output with the documented output."""

import os
import re
import shlex
import subprocess
from pathlib import Path

from pages import ROOT

PROSTM = Path(os.environ["PROSTM"])
# non-zero statuses with which a command may end here, without a tracker and on any machine
STATUSES = {"leap://": {3}, "openxr": {3}, "prostm check": {0, 1}, "prostm soak": {0, 1}}
# commands that are not run here: other tests run them, they take long, or they need another machine
ELSEWHERE = ("cmake ", "g++ ", "ssh ", "tools/", "PKG_CONFIG_PATH=", "prostm report")
SECONDS = 3  # of a real-time run: after 1.5 s it reports a missing tracker
FRAMES = 10  # of a recording of fields


def split_commands(text):
    """Splits text into commands: lines that end in a backslash and here-documents are joined."""
    command, end = "", None
    for line in text.splitlines():
        command += line + "\n"
        if end is None and (found := re.search(r"<<'?(\w+)'?", line)):
            end = found[1]
        if (end is None and not line.endswith("\\")) or line == end:
            if command.strip() and not command.startswith("#"):
                yield command.rstrip("\n")
            command, end = "", None
    assert not command, f"a command does not end: {command}"


def shortened(command):
    """The same command for 3 s if it would run longer in real time, with few fields if it would record or plan many,
    and with one trial and no participant if it would guide one."""
    words = re.sub(r"--frames \S+", f"--frames {FRAMES}", command.split("  #")[0])
    if words.startswith("prostm soak"):
        return re.sub(r" --minutes \S+", "", words) + f" --minutes {SECONDS / 60}"
    if words.startswith("prostm study run"):
        return words + ("" if "--rehearse" in words else " --rehearse 1")
    if not words.startswith("prostm run") or "--as-fast-as-possible" in words or "--stepped" in words:
        return words
    short, replaced = re.subn(r"--seconds \S+", f"--seconds {SECONDS}", words)
    return short if replaced else f"{short} --seconds {SECONDS}"


def statuses_of(command):
    return next((allowed for words, allowed in STATUSES.items() if words in command), {0})


def check_run(command):
    """Checks that ./run has the command, and the benchmark or comparison that it names."""
    words = shlex.split(command, comments=True)[1:]
    usage = subprocess.run([ROOT / "run", "--help"], capture_output=True, text=True, check=True).stdout
    assert re.search(rf"^  {words[0]}\b", usage, re.MULTILINE), f"./run has no {words[0]}"
    if words[0] in ("bench", "lab"):
        for name in words[1:]:
            if name.startswith("-"):
                break
            assert (ROOT / words[0] / f"{name}_{words[0]}.cpp").exists(), f"./run {words[0]} has no {name}"
    else:
        for option in filter(lambda w: w.startswith("--"), words[1:]):
            assert option in usage or words[0] == "demo", f"./run {words[0]} has no {option}"


def type_command(command, folder):
    """Runs a command with bash in `folder`. @return its output, both streams together."""
    if command.startswith("./run"):
        check_run(command)
        return None
    if command.startswith(ELSEWHERE):
        return None
    environment = os.environ | {"PATH": f"{PROSTM.parent}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-c", shortened(command)], cwd=folder, env=environment, timeout=120,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode in statuses_of(command), f"{command}\nended with {done.returncode}:\n{done.stdout}"
    return done.stdout


NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?")


def pattern_of(part):
    if part == "…":
        return ".*"
    return rf"({NUMBER.pattern})" if NUMBER.fullmatch(part) else re.sub(r"(?:\\ )+", r"\\ +", re.escape(part))


def same_number(said, printed):
    decimals = len(said.partition(".")[2])
    last_place = 10**-decimals if decimals else 0
    return abs(float(printed) - float(said)) <= 0.1 * abs(float(said)) + last_place + 1e-9


def same_line(said, printed):
    """Whether a line matches the documented one: … stands for anything, numbers may differ by a tenth (those with a
    point by one more in the last place), and gaps in width."""
    parts = re.split(rf"(…|{NUMBER.pattern})", said.rstrip())
    found = re.fullmatch("".join(map(pattern_of, parts)), printed.rstrip())
    return bool(found) and all(map(same_number, NUMBER.findall(said), found.groups()))


def check_output(said, printed):
    """Checks that the document shows the whole output, line by line; a line of … alone stands for any lines."""
    lines = iter(printed.strip("\n").splitlines())
    skipping = False
    for line in said.strip("\n").splitlines():
        if line.strip() == "…":
            skipping = True
            continue
        for got in lines:
            if same_line(line, got):
                break
            assert skipping, f"said:    {line}\nprinted: {got}\nin:\n{printed}"
        else:
            raise AssertionError(f"never printed: {line}\nin:\n{printed}")
        skipping = False
    left = None if skipping else next(lines, None)
    assert left is None, f"not shown: {left}\nin:\n{printed}"


def commands_of(block):
    """(command, documented output) of a block; for a block of `sh` the output is None."""
    if block.language == "sh":
        yield from ((command, None) for command in split_commands(block.text))
    elif block.language == "console":
        before, *parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
        assert not before, f"line {block.line}: a block of console begins with $ and a command"
        for part in parts:
            yield re.fullmatch(r"((?:[^\n]*\\\n)*[^\n]*)\n(.*)", part, flags=re.DOTALL).groups()
