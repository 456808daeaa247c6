"""The public workflow and the pre-commit hooks: each is well formed, and the commands that it calls exist."""

import itertools
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
HOOKS = ROOT / ".pre-commit-config.yaml"
OPTIONS = {"--full", "--changed"}


def read(path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def matrices_of(job):
    """The values of each combination of a job's matrix, by the names used in steps: matrix.compiler.cc."""
    matrix = job.get("strategy", {}).get("matrix", {})
    for values in itertools.product(*matrix.values()):
        names = {}
        for key, value in zip(matrix, values):
            fields = value if isinstance(value, dict) else {"": value}
            names |= {f"matrix.{key}.{field}".rstrip("."): of_field for field, of_field in fields.items()}
        yield names


def commands_of(path):
    """The commands of a workflow's steps, as run by each combination of the matrix."""
    for job in read(path)["jobs"].values():
        for names in matrices_of(job):
            for step in job["steps"]:
                text = re.sub(r"\$\{\{ *(.*?) *\}\}", lambda m: str(names[m[1]]), step.get("run", ""))
                yield from filter(None, map(str.strip, re.split(r"\n|&&", text)))


def check_command(command):
    """Asserts that ./run has the command with its options, and that scripts and presets exist."""
    words = command.split()
    if words[0] == "./run":
        done = subprocess.run(["bash", "-c", '. ./run; usage; echo "${!parts_of_full[@]}"'], cwd=ROOT, text=True,
                              capture_output=True, check=True)
        *usage, parts = done.stdout.splitlines()
        assert re.search(rf"^  {words[1]}\b", "\n".join(usage), re.M), f"./run has no {words[1]}"
        for option in words[2:]:
            name, _, value = option.partition("=")
            assert option in OPTIONS or name == "--only" and value in parts.split(), f"./run test has no {option}"
    elif "/" in words[0]:
        assert os.access(ROOT / words[0], os.X_OK), f"{words[0]} is no program of the tree"
    presets = {preset["name"] for preset in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]}
    for preset in re.findall(r"--preset[ =](\S+)", command):
        assert preset in presets, f"there is no preset {preset}"


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_commands_of_a_workflow_exist(path):
    commands = list(commands_of(path))
    assert "./run test" in commands
    for command in commands:
        check_command(command)


@pytest.mark.parametrize("command", ["./run fly", "./run test --full --only=ubsan", "./run test --fast", "tools/none.sh",
                                     "cmake --workflow --preset none"])
def test_a_missing_command_is_found(command):
    with pytest.raises(AssertionError):
        check_command(command)


def test_a_workflow_runs_every_part_of_full():
    commands = [command for path in WORKFLOWS for command in commands_of(path)]
    parts = re.findall(r"^declare -A parts_of_full=\((.*?)\)\n\n", (ROOT / "run").read_text(), re.M | re.S)
    for part in re.findall(r"\[(\w+)\]=", parts[0]):
        assert f"./run test --full --only={part}" in commands


def test_parts_of_full_name_its_tests():
    """Each entry that tests/full adds to the release build's tests belongs to one part, except random_targets."""
    lists = (ROOT / "tests" / "full" / "CMakeLists.txt").read_text()
    entries = {re.sub(r"\$\{.*?\}", "x", name) for name in re.findall(r"add_test\(NAME (\S+)", lists)}
    patterns = re.findall(r"\[\w+\]='(.*?)'", (ROOT / "run").read_text())
    for entry in entries - {"random_targets"}:
        assert sum(bool(re.search(pattern, entry)) for pattern in patterns) == 1, entry


def test_hooks_are_local_and_exist():
    for repository in read(HOOKS)["repos"]:
        assert repository["repo"] == "local"
        for hook in repository["hooks"]:
            assert hook["language"] in ("script", "system")
            if hook["language"] == "script":
                check_command(hook["entry"])


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_follows_the_schema(path):
    checker = ["check-jsonschema"] if shutil.which("check-jsonschema") else [sys.executable, "-m", "check_jsonschema"]
    if subprocess.run([*checker, "--version"], capture_output=True, check=False).returncode != 0:
        pytest.skip("needs the Python package check-jsonschema, which is not installed")
    done = subprocess.run([*checker, "--builtin-schema", "vendor.github-workflows", path], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
