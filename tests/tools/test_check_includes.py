"""tools/check_includes.py on small checkouts: a source includes the precompiled headers that it uses."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import check_includes  # noqa: E402


@pytest.fixture
def checked(tmp_path):
    def check(**files):
        for name, text in {"a.hpp": "", "a.cpp": "", **files}.items():
            path = tmp_path / "src/prostm" / name.replace("_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return list(check_includes.Checkout(tmp_path).listed())
    return check


def test_a_missing_header_is_listed_with_the_name(checked):
    assert checked(a_cpp="std::vector<int> x;\n") == [
        "src/prostm/a.cpp: uses std::vector and does not include <vector>"]


@pytest.mark.parametrize("header", ["#include <vector>\n", '#include "prostm/b.hpp"\n'])
def test_a_header_may_be_included_directly_or_through_the_project(checked, header):
    assert checked(b_hpp='#include "prostm/a.hpp"\n#include <vector>\n',
                   a_cpp=header + "std::vector<int> x;\n") == []


def test_names_in_comments_and_texts_do_not_count(checked):
    assert checked(a_cpp='// std::vector<int>\nconst char* x = "std::thread";\n') == []


def test_headers_that_include_each_other_end(checked):
    assert checked(a_hpp='#include "prostm/b.hpp"\n', b_hpp='#include "prostm/a.hpp"\n',
                   a_cpp='#include "prostm/a.hpp"\n') == []


def test_every_precompiled_header_is_checked():
    listed = (ROOT / "cmake/prostm_stage.cmake").read_text().split("set(prostm_slow_headers")[1].split(")")[0]
    headers = {name.strip("<>") for name in listed.split()}
    assert headers == set(check_includes.NAMES) | {"Eigen/Geometry"}
