"""`import prostm` if the compiled part is missing, or belongs to another interpreter."""

import shutil
import subprocess
import sys
from pathlib import Path

import prostm
import pytest

from conftest import ROOT


def import_from(folder):
    """Returns the last line of the error of `import prostm` with this folder first on the path."""
    code = "import sys; sys.path.insert(0, sys.argv[1]); import prostm"
    done = subprocess.run([sys.executable, "-c", code, str(folder)], capture_output=True, text=True)
    assert done.returncode == 1
    return done.stderr.splitlines()[-1]


@pytest.fixture
def package(tmp_path):
    """Returns a copy of the package without its compiled part."""
    return Path(shutil.copytree(Path(prostm.__file__).parent, tmp_path / "prostm",
                                ignore=shutil.ignore_patterns("_prostm.*", "__pycache__")))


def test_the_sources_are_not_an_empty_package(package):
    for folder in (ROOT / "python", package.parent):
        error = import_from(folder)
        assert error.startswith("ImportError: prostm in ") and "has not been built: run ./run python" in error


def test_another_interpreters_module_is_named(package):
    (package / "_prostm.cpython-38-x86_64-linux-gnu.so").write_bytes(b"")
    error = import_from(package.parent)
    assert "was built for another interpreter (_prostm.cpython-38-x86_64-linux-gnu.so), and this is Python 3." in error


def test_a_broken_module_keeps_its_error(package):
    (package / "_prostm.so").write_bytes(b"not a library")
    assert "cannot be loaded by Python 3." in import_from(package.parent)

