"""The built program and the installed libraries contain no code of the lab, benchmarks or tests."""

import os
import re
from pathlib import Path

import pytest

from symbols import defined, foreign

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("PROSTM_BUILD", ROOT / "build" / "release"))


def installed():
    """Returns the stages that cmake/install.cmake installs."""
    text = (ROOT / "cmake" / "install.cmake").read_text(encoding="utf-8")
    return " ".join(re.findall(r"^\s*prostm_install\(\w+ ([^)]*)\)", text, re.M)).split()


@pytest.mark.parametrize("name", [
    "prostm::bench::compute_gap(std::string const&)",
    "void prostm::bench::add_rows<int>(int)",
    "prostm::(anonymous namespace)::read(prostm::bench::Row const&)",
    "testing::Test::SetUp()",
    "prostm::test::cell_centre(prostm::SkinPatch const&, int, int)",
    "void std::sort<test::Item*>(test::Item*)",
])
def test_names_of_the_lab_and_of_tests_are_found(name):
    assert foreign(["main", name]) == [name]


@pytest.mark.parametrize("name", [
    "prostm::app::bench_command(int)",
    "prostm::methods::draw_ways(std::string const&)",
    "prostm::experiments::gap_curves(int)",
    "prostm::workbench::run()",
    "prostm::latest::at(int)",
    "boost::beast::test::fail_count::fail()",
])
def test_names_of_stages_and_of_the_program_are_not_found(name):
    assert foreign([name]) == []


def test_the_program_defines_no_such_names():
    names = defined(BUILD / "prostm")
    assert len(names) > 1000, "a program without names proves nothing"
    assert foreign(names) == []


def test_the_library_defines_no_such_names():
    stages = installed()
    assert {"core", "plan", "device", "pipeline"} <= set(stages)
    for stage in stages:
        names = defined(BUILD / f"libprostm_{stage}.a")
        assert names, stage
        assert foreign(names) == [], stage
