"""Runs all commands and Python code of the documents, compares their output with the documented output, and reads the
documents' files. tools/check_links.py follows their links."""

import json
import os
import subprocess
import sys

import pytest
import shell
from pages import PAGES, ROOT, blocks_of, name_of, python_of

LANGUAGES = {"sh", "console", "python", "json", "toml", "cmake", "text"}
# the command that reads each file format
READERS = {
    "prostm-field/1": "prostm plan FILE",
    "prostm-plan/1": "prostm field FILE",
    "prostm-array/1": "prostm solve data/foci.json --array FILE",
    "prostm-foci/1": "prostm solve FILE",
    "prostm-pose/1": "prostm run --tracker FILE --seconds 1 --stepped --grid 32",
}
END = "--- the end of a block ---"


@pytest.fixture(scope="module", params=PAGES, ids=name_of)
def page(request):
    return request.param


@pytest.fixture(scope="module")
def folder(page, tmp_path_factory):
    """A folder that looks like the project's, so that files written by a page's commands are discarded."""
    folder = tmp_path_factory.mktemp(page.stem)
    for name in ("data", "examples", "tools"):
        (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.fixture(scope="module")
def typed(page, folder):
    """(command, documented output, actual output) of each command of the page, run in `folder`; the page's Python uses
    the files that they wrote."""
    return [(command, said, shell.type_command(command, folder))
            for block in blocks_of(page) for command, said in shell.commands_of(block)]


def test_blocks_name_their_language(page):
    wrong = [f"line {b.line}: {b.language!r}" for b in blocks_of(page) if b.language not in LANGUAGES]
    assert not wrong, f"a block is one of {sorted(LANGUAGES)}, not {wrong}"


def test_commands_print_the_documented_output(typed):
    for command, said, printed in typed:
        if said is not None:
            assert printed is not None, f"nothing types this command, so its block is one of sh: {command}"
            shell.check_output(said, printed)


def test_python_prints_the_documented_output(page, folder, typed):
    blocks = python_of(page)
    if not blocks:
        pytest.skip("the page has no Python")
    if not os.environ.get("PROSTM_PYTHON"):
        pytest.skip("this build has no Python module")
    code = "".join(f"{text}print({END!r})\n" for text, _ in blocks)
    environment = os.environ | {"PYTHONPATH": os.environ["PROSTM_PYTHON"]}
    done = subprocess.run([sys.executable, "-u", "-c", code], cwd=folder, env=environment, timeout=300,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode == 0, done.stdout
    for (_, said), printed in zip(blocks, done.stdout.split(END)[:-1], strict=True):
        shell.check_output(said, printed)


def test_files_are_read(page, folder):
    for number, block in enumerate(blocks_of(page), 1):
        if block.language == "toml":
            (folder / "page.toml").write_text(block.text)
            study = f"prostm study run page.toml --participant {number} --answers protocol"
            shell.type_command(study if "[study]" in block.text else "prostm settings --settings page.toml", folder)
        elif block.language == "json":
            reader = READERS.get(json.loads(block.text).get("format"))
            if reader is not None:
                (folder / "page.json").write_text(block.text)
                shell.type_command(reader.replace("FILE", "page.json"), folder)
