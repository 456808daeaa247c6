"""Tests the check of lengths: it counts a function's lines in any context, and recognises other braces."""

import subprocess
import sys
from pathlib import Path

import pytest

from checks import check_file

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_lengths.py"
LINE = "  f();\n"


def check(root, name="src/prostm/plan/a.cpp", text=""):
    """Returns the exit status and the output lines of the tool for a tree of one file."""
    return check_file(TOOL, root, name, text)


@pytest.mark.parametrize("before, head, name", [
    ("", "void long_one() {\n", "long_one"),
    ("\nnamespace a::b {\nnamespace {\nint x = 3;\n", "void long_one() {\n", "long_one"),
    ('extern "C" {\n', "int long_one(int a = 3) noexcept {\n", "long_one"),
    ("class A final : public B {\n public:\n  A() = default;\n", "  bool operator==(const A&) const {\n", "operator=="),
    ("", "template <class T, class U = std::vector<T>>\nauto A<T>::g(U u) const -> decltype(u) {\n", "A<T>::g"),
    ("int x{3};\n", "A::A(int n)\n    : b_{n},\n      c_(n),\n      d_{n, {1, 2}} {\n", "A::A"),
    ("", "[[nodiscard]] HWY_INLINE static double g(double (*get)(int), int n) {\n", "g"),
    ("struct B {};\nenum class C { A, B };\n", "void A::operator()(int i) {\n", "A::operator()"),
    ("#define TWICE(x) { \\\n  x; \\\n  x\n", "void g() {  // }\n  auto s = \"}\"; char c = '}';\n", "g"),
])
def test_counts_a_function_from_its_head_to_its_last_brace(tmp_path, before, head, name):
    most = before + head + LINE * (60 - head.count("\n") - 1)
    assert check(tmp_path, text=most + "}\n")[0] == 0
    status, lines = check(tmp_path, text=most + LINE + "}\n")
    first = before.count("\n") + 1
    assert (status, lines) == (1, [f"src/prostm/plan/a.cpp:{first}: {name} has 61 lines: at most 60"])


def test_a_lambda_belongs_to_its_function(tmp_path):
    text = "void g() {\n  const auto h = [&](int i) {\n" + 59 * LINE + "  };\n}\n"
    assert check(tmp_path, text=text)[1] == ["src/prostm/plan/a.cpp:1: g has 63 lines: at most 60"]


@pytest.mark.parametrize("text", [
    "constexpr A kTable[] = {\n" + "  {f(1), 2},\n" * 80 + "};\n",
    "const std::array<A, 80> kTable{{\n" + "  {f(1), 2},\n" * 80 + "}};\n",
    "enum class A {\n" + "  B,\n" * 80 + "};\n",
    "struct A {\n" + "  int f() const { return 1; }\n  int a{g(1)};\n" * 40 + "};\n",
    "namespace a {\n" + "void f() {\n  if (a) {\n  }\n}\n" * 40 + "}\n",
])
def test_data_and_types_may_be_long(tmp_path, text):
    assert check(tmp_path, text=text)[0] == 0


@pytest.mark.parametrize("name", ["src/prostm/plan/a.hpp", "apps/prostm/a.cpp"])
def test_a_file_has_at_most_450_lines(tmp_path, name):
    (tmp_path / "src").mkdir()
    assert check(tmp_path, name, "\n" * 450)[0] == 0
    assert check(tmp_path, name, "\n" * 451) == (1, [f"{name}:1: 451 lines: at most 450"])


def test_other_folders_are_ignored(tmp_path):
    (tmp_path / "src").mkdir()
    assert check(tmp_path, "tests/plan/a_test.cpp", "void f() {\n" + 59 * LINE + "}\n")[0] == 0


def test_a_folder_without_sources_is_an_error(tmp_path):
    result = subprocess.run([sys.executable, str(TOOL), str(tmp_path)], capture_output=True, text=True)
    assert result.returncode == 2
    assert "has no src" in result.stderr
