"""The layer check itself: it finds what it is there to find, and nothing in a tree that keeps the rules."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_layers.py"

GOOD = {
    "CMakeLists.txt": "prostm_stage(core PUBLIC Eigen3::Eigen)\nprostm_stage(target PUBLIC prostm_core)\n"
                      "prostm_stage(plan PUBLIC prostm_target PRIVATE hwy::hwy)\nprostm_stage(track PUBLIC prostm_core)\n"
                      "prostm_stage(hand PUBLIC prostm_track)\nprostm_stage(fluid PUBLIC prostm_hand)\n"
                      "prostm_stage(acoustics PUBLIC prostm_core)\nprostm_stage(emit PUBLIC prostm_plan\n  prostm_target)\n"
                      "prostm_stage(device PUBLIC prostm_emit prostm_acoustics)\nprostm_stage(score PUBLIC prostm_plan)\n"
                      "prostm_stage(io PUBLIC prostm_score)\n",
    "apps/CMakeLists.txt": "target_link_libraries(prostm PRIVATE prostm_io\n  fmt::fmt)\n",
    "src/core/worker_pool.cpp": '#include <thread>\n#include "core/worker_pool.hpp"\nstd::mutex mutex;\n',
    "src/core/stage_timer.hpp": "#include <chrono>\nusing Clock = std::chrono::steady_clock;\n",
    "src/target/field.hpp": '#include "core/units.hpp"\n#include <vector>\n',
    "src/plan/planner.cpp": '#include "plan/planner.hpp"\n#include "target/field.hpp"\n'
                            '// std::cout << "a comment may say #include <thread> and std::mutex"\n'
                            'const char* text = "std::cout << printf(1)";\nint n = 10\'000; char c = \'"\';\n',
    "src/device/simulated.cpp": '#include <thread>\n#include <chrono>\n#include "emit/emitter.hpp"\n',
    "src/io/file.cpp": '#include "score/score.hpp"\n#include <fstream>\nint n = std::snprintf(b, 9, "x");\n',
    "apps/prostm/main.cpp": '#include <iostream>\n#include "io/file.hpp"\nint main() { std::cout << 1; }\n',
    "tests/plan/planner_test.cpp": '#include <thread>\n#include "io/file.hpp"\n',
}


def check(root):
    """Exit status and the lines that the tool prints about the tree in `root`."""
    result = subprocess.run([sys.executable, str(TOOL), str(root)], capture_output=True, text=True)
    return result.returncode, result.stdout.splitlines()


@pytest.fixture
def tree(tmp_path):
    """A function that writes files into a tree that keeps every rule, and gives its root."""

    def write(files=()):
        for name, text in {**GOOD, **dict(files)}.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    return write


def test_accepts_a_tree_that_keeps_the_rules(tree):
    assert check(tree()) == (0, ["layers: every #include is of what CMake links"])


@pytest.mark.parametrize("name, text, line, word", [
    ("src/target/a.hpp", '\n#include "plan/plan.hpp"\n', 2, "target must not include plan"),
    ("src/plan/a.cpp", '#include "fluid/fluid.hpp"\n', 1, "plan must not include fluid"),
    ("src/core/a.hpp", '#include "target/field.hpp"\n', 1, "core must not include target"),
    ("src/acoustics/a.cpp", '  #  include "emit/emitter.hpp"\n', 1, "acoustics must not include emit"),
    ("src/plan/a.cpp", '#include <target/field.hpp>\n', 1, "with quotes"),
    ("src/plan/a.cpp", '#include "../target/field.hpp"\n', 1, "relative"),
    ("src/plan/a.cpp", '#include "field.hpp"\n', 1, "no header of a stage"),
    ("src/plan/a.cpp", '#include "prostm/run.hpp"\n', 1, "no header of a stage"),
    ("src/magic/a.cpp", "\n", 1, "in no layer"),
    ("src/emit/a.cpp", '#include "acoustics/array.hpp"\n', 1, "emit must not include acoustics"),
    ("apps/prostm/a.cpp", '\n#include "fluid/fluid.hpp"\n', 2, "apps must not include fluid"),
    ("src/fluid/a.cpp", "#include <thread>\n", 1, "<thread>"),
    ("src/fluid/a.cpp", "#include <mutex>\n", 1, "<mutex>"),
    ("src/hand/a.cpp", "#include <condition_variable>\n", 1, "<condition_variable>"),
    ("src/core/latest.hpp", "#include <mutex>\n", 1, "<mutex>"),
    ("src/core/worker_pool.hpp", "#include <chrono>\n", 1, "<chrono>"),
    ("src/track/a.cpp", "#include <chrono>\n", 1, "<chrono>"),
    ("src/emit/a.cpp", "void f();\nstd::jthread worker;\n", 2, "std::jthread"),
    ("src/emit/a.cpp", "std::scoped_lock l(m); std::shared_mutex m;\n", 1, "std::shared_mutex"),
    ("src/plan/a.cpp", "auto t = std::chrono::steady_clock::now();\n", 1, "std::chrono"),
    ("src/plan/a.cpp", "#include <iostream>\n", 1, "<iostream>"),
    ("src/device/a.cpp", "std::cout << 1;\n", 1, "std::cout"),
    ("src/io/a.cpp", 'std::fprintf(stderr, "x");\n', 1, "fprintf"),
    ("src/io/a.cpp", 'fmt::print("x");\n', 1, "fmt::print"),
    ("src/plan/a.cpp", "#include <format>\n", 1, "<format>"),
    ("apps/prostm/a.cpp", "#include <expected>\n", 1, "<expected>"),
    ("tests/plan/a_test.cpp", "auto v = x | std::views::take(3);\n", 1, "std::views"),
    ("bench/a_bench.cpp", "auto v = x | std::ranges::views::reverse;\n", 1, "views"),
    ("src/plan/planner_old.cpp", "\n", 1, "old copy"),
    ("src/plan/planner_v2.cpp", "\n", 1, "old copy"),
    ("src/plan/planner.cpp.bak", "\n", 1, "old copy"),
    ("docs/design_old.md", "\n", 1, "old copy"),
])
def test_finds_each_violation_where_it_is(tree, name, text, line, word):
    status, lines = check(tree([(name, text)]))
    assert status == 1
    assert len(lines) == 1, lines
    assert lines[0].startswith(f"{name}:{line}: ")
    assert word in lines[0]


def test_finds_every_violation_of_a_file(tree):
    status, lines = check(tree([("src/emit/a.cpp", "#include <thread>\n#include <iostream>\nstd::thread t;\n")]))
    assert status == 1
    assert [line.split(":")[1] for line in lines] == ["1", "2", "3"]


def test_a_program_may_include_what_the_linked_stages_link(tree):
    files = [("apps/prostm/a.cpp", '#include "plan/plan.hpp"\n#include "core/units.hpp"\n#include "options.hpp"\n')]
    assert check(tree(files))[0] == 0


def test_a_folder_without_sources_is_an_error(tmp_path):
    result = subprocess.run([sys.executable, str(TOOL), str(tmp_path)], capture_output=True, text=True)
    assert result.returncode == 2
    assert "has no src" in result.stderr
