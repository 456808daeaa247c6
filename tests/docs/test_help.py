"""Runs the examples in the program's help, like a newcomer who copies them."""

import shell
from pages import ROOT

# each uses the files written by those before it; first-run.md runs prostm check, which takes long
COMMANDS = ["run", "plan", "field", "solve", "capture", "bench", "settings", "devices", "selftest", "soak",
            "study analyse", "study run", "study simulate", "help"]


def test_the_examples_of_help_work_in_the_projects_folder(tmp_path):
    (tmp_path / "data").symlink_to(ROOT / "data")
    listed = shell.type_command("prostm --help", tmp_path)
    for command in COMMANDS:
        assert f"\n  {command.partition(' ')[0]} " in listed
        _, _, examples = shell.type_command(f"prostm {command} --help", tmp_path).partition("Example:\n")
        assert examples, f"prostm {command} --help has no example"
        for example in examples.strip().splitlines():
            shell.type_command(example.strip(), tmp_path)
