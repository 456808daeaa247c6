"""Tests the check by Vale, with a stand-in for Vale that prints its arguments."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def check(tmp_path, vale, script=None):
    """Returns the exit status and output of check_prose.sh, with `vale` as $VALE and the script in it."""
    program = tmp_path / "vale"
    if script:
        program.write_text(f"#!/bin/bash\n{script}\n")
        program.chmod(0o755)
    done = subprocess.run([ROOT / "tools" / "check_prose.sh"], capture_output=True, text=True,
                          env={**os.environ, "VALE": str(program if vale else tmp_path / "absent")})
    return done.returncode, done.stdout


def test_vale_reads_documents_and_headers_with_our_rules(tmp_path):
    status, told = check(tmp_path, vale=True, script='printf "%s\\n" "$@"')
    assert status == 0
    lines = told.splitlines()
    assert lines[:4] == ["--config", ".vale.ini", "--output", "line"]
    assert {"README.md", "docs/guides/build.md", "src/prostm/plan/planner.hpp"} <= set(lines)
    assert not [line for line in lines if line.endswith(".cpp")]


def test_findings_of_vale_fail_the_check(tmp_path):
    assert check(tmp_path, vale=True, script="echo README.md:1:1:prostm.Wordy:found; exit 1")[0] == 1


def test_without_vale_it_reports_so_and_succeeds(tmp_path):
    if (ROOT / "build" / "tools" / "vale").exists():
        pytest.skip("Vale is in build/tools")
    status, told = check(tmp_path, vale=False)
    assert status == 0
    assert told.startswith("skipped: there is no Vale")
