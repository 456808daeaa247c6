"""tools/check_headers.py: a header must include what it uses, also if it reaches Eigen."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools/check_headers.py"
ACCEPTED = "headers: clang accepts 1 of 1 on their own\n"

pytestmark = pytest.mark.skipif(not (shutil.which("clang++") and shutil.which("pkg-config")),
                                reason="needs clang and pkg-config")


def check_in(folder, text, **environment):
    """Checks a checkout of one header, and returns the process."""
    header = folder / "src/prostm/core/one.hpp"
    header.parent.mkdir(parents=True, exist_ok=True)
    header.write_text("#pragma once\n" + text)
    return subprocess.run([sys.executable, str(TOOL), str(folder)], text=True, capture_output=True, cwd=folder,
                          env=os.environ | environment)


@pytest.mark.parametrize("include", ["", "#include <Eigen/Core>\n"])
def test_a_missing_include_is_refused(tmp_path, include):
    use = "inline std::optional<int> none() { return {}; }\n"
    refused = check_in(tmp_path, include + use)
    assert refused.returncode == 1
    assert "one.hpp" in refused.stdout and "optional" in refused.stdout
    accepted = check_in(tmp_path, include + "#include <optional>\n" + use)
    assert (accepted.returncode, accepted.stdout) == (0, ACCEPTED)


@pytest.mark.skipif(not shutil.which("ccache"), reason="needs ccache")
def test_a_checkout_does_not_use_the_precompiled_headers_of_another(tmp_path):
    for name in ("one", "two"):
        folder = tmp_path / name
        process = check_in(folder, f"#include <string>\ninline std::string {name}() {{ return {{}}; }}\n",
                           CCACHE_DIR=str(tmp_path / "cache"), CCACHE_BASEDIR=str(folder), CCACHE_NOHASHDIR="1",
                           CCACHE_DEPEND="1",
                           CCACHE_SLOPPINESS="pch_defines,time_macros,include_file_mtime,include_file_ctime")
        assert (process.returncode, process.stdout, process.stderr) == (0, ACCEPTED, "")
        shutil.rmtree(folder)
