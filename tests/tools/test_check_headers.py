"""tools/check_headers.py: a header must include what it uses, also if it reaches Eigen."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools/check_headers.py"

pytestmark = pytest.mark.skipif(not (shutil.which("clang++") and shutil.which("pkg-config")),
                                reason="needs clang and pkg-config")


@pytest.fixture
def check(tmp_path):
    """Returns a function that checks a checkout of one header, and returns the process."""

    def run(text):
        header = tmp_path / "src/prostm/core/one.hpp"
        header.parent.mkdir(parents=True, exist_ok=True)
        header.write_text("#pragma once\n" + text)
        return subprocess.run([sys.executable, str(TOOL), str(tmp_path)], text=True, capture_output=True)

    return run


@pytest.mark.parametrize("include", ["", "#include <Eigen/Core>\n"])
def test_a_missing_include_is_refused(check, include):
    use = "inline std::optional<int> none() { return {}; }\n"
    refused = check(include + use)
    assert refused.returncode == 1
    assert "one.hpp" in refused.stdout and "optional" in refused.stdout
    accepted = check(include + "#include <optional>\n" + use)
    assert (accepted.returncode, accepted.stdout) == (0, "headers: clang accepts 1 of 1 on their own\n")
