"""The pages for contributors: the files and commands that they name exist."""

import re
from pathlib import Path

import pytest
from test_ci import check_command

ROOT = Path(__file__).resolve().parents[2]
PAGES = ["CONTRIBUTING.md", "SECURITY.md"]


def named_in(page):
    """All texts in `…` on a page."""
    return re.findall(r"`([^`\n]+)`", (ROOT / page).read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES)
def test_the_files_that_a_page_names_exist(page):
    folders = tuple(f"{path.name}/" for path in ROOT.iterdir() if path.is_dir() and path.name != "build")
    for name in named_in(page):
        path = name.split()[0]
        if path.startswith(folders):
            place = re.sub(r"[^/]*[A-Z].*", "", path)  # tests/STAGE/ stands for each stage
            assert (ROOT / place).exists(), f"{page} names {path}: revise its row"


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_that_a_page_names_exist(page):
    for name in named_in(page):
        if name.startswith(("./run test", "./run build")):
            check_command(" ".join(word for word in name.split() if word not in ("-R", "plan")))


def test_names_in_the_table_exist_in_the_code():
    """Each word that looks like a C++ type or function occurs in a file named in its row."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for row in re.findall(r"^\| (?:device|array|preset|world|metric|study task|setting) .*$", text, re.M):
        names = re.findall(r"`([^`]+)`", row)
        sources = [ROOT / name for name in names if name.endswith((".cpp", ".hpp")) and (ROOT / name).is_file()]
        code = "".join(path.read_text(encoding="utf-8") for path in sources)
        for name in names:
            if word := re.fullmatch(r"([A-Z]\w+[a-z]|\w+)(?:\(\))?", name):
                assert word[1] in code, f"{name} is not in the files of its row: {row[:40]}"
