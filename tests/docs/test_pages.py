"""Types every command of the documents, runs their Python, reads their files, and follows their links."""

import json
import os
import subprocess
import sys

import pytest
import shell
from pages import PAGES, ROOT, anchors_of, blocks_of, links_of, name_of

LANGUAGES = {"sh", "console", "python", "json", "toml", "cmake", "text"}
# the command that reads a file of each format
READERS = {
    "prostm-field/1": "prostm plan FILE",
    "prostm-plan/1": "prostm field FILE",
    "prostm-array/1": "prostm solve data/foci.json --array FILE",
    "prostm-foci/1": "prostm solve FILE",
    "prostm-pose/1": "prostm run --tracker FILE --seconds 1 --stepped --grid 32",
}

every_page = pytest.mark.parametrize("page", PAGES, ids=name_of)


@pytest.fixture
def folder(tmp_path):
    """A folder that looks like the project's, so that what commands write is thrown away."""
    for name in ("data", "examples", "tools"):
        (tmp_path / name).symlink_to(ROOT / name)
    return tmp_path


@every_page
def test_blocks_name_their_language(page):
    wrong = [f"line {b.line}: {b.language!r}" for b in blocks_of(page) if b.language not in LANGUAGES]
    assert not wrong, f"a block is one of {sorted(LANGUAGES)}, not {wrong}"


@every_page
def test_links_lead_somewhere(page):
    for link in links_of(page):
        if link.startswith(("http://", "https://", "mailto:")):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{link}: no such file"
        if anchor:
            assert anchor in anchors_of(target), f"{link}: no such heading"


@every_page
def test_commands_do_what_the_page_says(page, folder):
    for block in blocks_of(page):
        if block.language == "sh":
            for command in shell.split_commands(block.text):
                shell.type_command(command, folder)
        elif block.language == "console":
            shell.run_console(block.text, folder)


@every_page
def test_python_runs(page, folder):
    code = "\n".join(b.text for b in blocks_of(page) if b.language == "python")
    if not code:
        pytest.skip("the page has no Python")
    if not os.environ.get("PROSTM_PYTHON"):
        pytest.skip("this build has no Python module")
    # the page's own files, from its commands
    for block in blocks_of(page):
        for command in shell.split_commands(block.text) if block.language == "sh" else ():
            shell.type_command(command, folder)
    environment = os.environ | {"PYTHONPATH": os.environ["PROSTM_PYTHON"]}
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=environment, timeout=300,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode == 0, done.stdout


@every_page
def test_files_are_read(page, folder):
    for block in blocks_of(page):
        if block.language == "toml":
            (folder / "page.toml").write_text(block.text)
            shell.type_command("prostm settings --settings page.toml", folder)
        elif block.language == "json":
            reader = READERS.get(json.loads(block.text).get("format"))
            if reader is not None:
                (folder / "page.json").write_text(block.text)
                shell.type_command(reader.replace("FILE", "page.json"), folder)
