"""The measures of the layout: they find large folders and cycles, and this repository keeps the bounds."""

import subprocess
import sys
from pathlib import Path

from checks import check

TOOL = Path(__file__).resolve().parents[2] / "tools" / "house.py"


def repository(root, files):
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    for arguments in (["init", "-q"], ["add", "-A"]):
        subprocess.run(["git", "-C", root, *arguments], check=True)
    return root


def test_a_tree_within_the_bounds_passes(tmp_path):
    files = {f"src/prostm/plan/a{i}.hpp": "#pragma once\n" for i in range(24)}
    files["src/prostm/plan/b.cpp"] = '#include "prostm/plan/a1.hpp"\nint one() {\n  return 1;\n}\n'
    status, lines = check(TOOL, repository(tmp_path, files))
    assert status == 0
    assert lines == ["longest file: src/prostm/plan/b.cpp, 4 lines", "longest function: src/prostm/plan/b.cpp: one, 3 lines"]


def test_a_large_folder_is_found(tmp_path):
    files = {f"docs/a{i}.md": "\n" for i in range(26)}
    files["src/prostm/plan/b.cpp"] = "int one() {\n}\n"
    status, lines = check(TOOL, repository(tmp_path, files))
    assert (status, lines[0]) == (1, "docs: 26 files, above 25")


def test_an_include_that_closes_a_cycle_is_found(tmp_path):
    files = {"src/prostm/plan/a.hpp": '#include "prostm/plan/b.hpp"\n', "src/prostm/plan/b.hpp": "\n",
             "src/prostm/plan/b.cpp": '#include "prostm/plan/a.hpp"\nint one() {\n}\n'}
    status, lines = check(TOOL, repository(tmp_path, files))
    assert (status, lines[-1]) == (1, "arrow back: src/prostm/plan/b -> src/prostm/plan/a")


def test_this_repository_keeps_the_bounds():
    run = subprocess.run([sys.executable, TOOL], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout
