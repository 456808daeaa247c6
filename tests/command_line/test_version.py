"""The version and the commit, in the program's output and files."""

import json
import re
import subprocess

import h5py
import pytest

from conftest import ROOT
from test_commands import blob_field

VERSION = re.compile(r"(\d+\.\d+\.\d+)(?: \(([0-9a-f]{12})(-dirty)?\))?")


@pytest.fixture
def version(prostm):
    text = prostm("--version").stdout.strip()
    assert VERSION.fullmatch(text), text
    return text


def test_the_version_names_the_commit_of_a_checkout(version):
    head = subprocess.run(["git", "-c", "safe.directory=*", "-C", str(ROOT), "rev-parse", "--verify", "HEAD"],
                          capture_output=True, text=True)
    if head.returncode != 0:
        pytest.skip("the sources are no checkout")
    assert VERSION.fullmatch(version)[2] == head.stdout[:12]


@pytest.mark.long
def test_files_name_the_version_that_wrote_them(prostm, version, tmp_path):
    (tmp_path / "blob.json").write_text(json.dumps(blob_field()))
    prostm("plan", "blob.json", "--json", "plan.json")
    prostm("field", "plan.json", "--json", "field.json")
    prostm("run", "--stepped", "--grid", "32", "--seconds", "0.2", "--record", "run.h5", "--json", "run.json")
    prostm("capture", "--grid", "32", "--frames", "1", "--out", "capture.h5")
    for name in ("plan.json", "field.json", "run.json"):
        assert json.loads((tmp_path / name).read_text())["prostm"] == version
    for name in ("run.h5", "capture.h5"):
        with h5py.File(tmp_path / name) as h5:
            assert h5.attrs["prostm"] == version
