"""Tests the check of layers: it finds violations, and accepts a tree that keeps the rules."""

import subprocess
import sys
from pathlib import Path

import pytest

from checks import check

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_layers.py"

GOOD = {
    "CMakeLists.txt": "prostm_stage(core PUBLIC Eigen3::Eigen)\nprostm_stage(target PUBLIC prostm_core)\n"
                      "prostm_stage(plan PUBLIC prostm_target PRIVATE hwy::hwy)\nprostm_stage(track PUBLIC prostm_core)\n"
                      "prostm_stage(hand PUBLIC prostm_track)\nprostm_stage(fluid PUBLIC prostm_hand)\n"
                      "prostm_stage(acoustics PUBLIC prostm_core)\nprostm_stage(emit PUBLIC prostm_plan\n  prostm_target)\n"
                      "prostm_stage(device PUBLIC prostm_emit prostm_acoustics)\nprostm_stage(score PUBLIC prostm_plan)\n"
                      "prostm_stage(io PUBLIC prostm_score)\n",
    "apps/CMakeLists.txt": "target_link_libraries(prostm PRIVATE prostm_io\n  fmt::fmt)\n",
    "src/prostm/core/worker_pool.cpp": '#include <thread>\n#include "prostm/core/worker_pool.hpp"\nstd::mutex mutex;\n',
    "src/prostm/core/stage_timer.hpp": "#include <chrono>\nusing Clock = std::chrono::steady_clock;\n",
    "src/prostm/target/field.hpp": '#include "prostm/core/units.hpp"\n#include <vector>\n',
    "src/prostm/plan/planner.cpp": '#include "prostm/plan/planner.hpp"\n#include "prostm/target/field.hpp"\n'
                            '// std::cout << "a comment may say #include <thread> and std::mutex"\n'
                            'const char* text = "std::cout << printf(1)";\nint n = 10\'000; char c = \'"\';\n',
    "src/prostm/device/simulated.cpp": '#include <thread>\n#include <chrono>\n#include "prostm/emit/emitter.hpp"\n',
    "src/prostm/io/file.cpp": '#include "prostm/score/score.hpp"\n#include <fstream>\nint n = std::snprintf(b, 9, "x");\n',
    "apps/prostm/main.cpp": '#include <iostream>\n#include "prostm/io/file.hpp"\nint main() { std::cout << 1; }\n',
    "src/prostm/plan/detail/fit/fit.cpp": '#include "prostm/plan/detail/fit/fit.hpp"\n#include "prostm/plan/detail/a.hpp"\n',
    "src/prostm/prostm.hpp": '#include "prostm/device/device.hpp"\n#include "prostm/version.hpp"\n',
    "lab/methods/tables.hpp": "\n",
    "tests/plan/planner_test.cpp": '#include <thread>\n#include "prostm/io/file.hpp"\n#include "prostm/plan/detail/a.hpp"\n',
}


@pytest.fixture
def tree(tmp_path):
    """Returns a function that writes files into a tree that keeps all rules, and returns its root."""

    def write(files=()):
        for name, text in {**GOOD, **dict(files)}.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    return write


def test_accepts_a_tree_that_keeps_the_rules(tree):
    assert check(TOOL, tree()) == (0, ["layers: every #include is of a stage that CMake links"])


@pytest.mark.parametrize("name, text, line, word", [
    ("src/prostm/target/a.hpp", '\n#include "prostm/plan/plan.hpp"\n', 2, "target must not include plan"),
    ("src/prostm/plan/a.cpp", '#include "prostm/fluid/fluid.hpp"\n', 1, "plan must not include fluid"),
    ("src/prostm/core/a.hpp", '#include "prostm/target/field.hpp"\n', 1, "core must not include target"),
    ("src/prostm/acoustics/a.cpp", '  #  include "prostm/emit/emitter.hpp"\n', 1, "acoustics must not include emit"),
    ("src/prostm/plan/a.cpp", '#include <prostm/target/field.hpp>\n', 1, "with quotes"),
    ("src/prostm/plan/a.cpp", '#include "../target/field.hpp"\n', 1, "relative"),
    ("src/prostm/plan/a.cpp", '#include "field.hpp"\n', 1, "not a header of a stage"),
    ("src/prostm/plan/a.cpp", '#include "prostm/run.hpp"\n', 1, "not a header of a stage"),
    ("src/prostm/magic/a.cpp", "\n", 1, "in no layer"),
    ("src/prostm/emit/a.cpp", '#include "prostm/acoustics/array/array.hpp"\n', 1, "emit must not include acoustics"),
    ("apps/prostm/a.cpp", '\n#include "prostm/fluid/fluid.hpp"\n', 2, "apps must not include fluid"),
    ("apps/prostm/a.cpp", '#include "prostm/plan/detail/costs.hpp"\n', 1, "private to plan"),
    ("src/prostm/emit/a.cpp", '#include "prostm/plan/detail/costs.hpp"\n', 1, "private to plan"),
    ("src/prostm/plan/detail/paper/a.cpp", '#include "prostm/plan/detail/fit/b.hpp"\n', 1, "must not include plan/detail/fit"),
    ("src/prostm/plan/detail/fit/a.cpp", '#include "prostm/plan/planner.hpp"\n', 1, "must not include plan/planner.hpp"),
    ("src/prostm/plan/detail/a.cpp", '#include "prostm/plan/detail/fit/b.hpp"\n', 1, "must not include plan/detail/fit"),
    ("src/prostm/device/safety/a.cpp", '#include "prostm/device/stream/b.hpp"\n', 1, "must not include device/stream"),
    ("src/prostm/device/stream/detail/a.cpp", '#include "prostm/device/autd3/b.hpp"\n', 1,
     "device/stream must not include device/autd3"),
    ("src/prostm/device/autd3/a.cpp", '#include "prostm/device/device_kinds.hpp"\n', 1,
     "must not include device/device_kinds.hpp"),
    ("src/plan/a.cpp", "\n", 1, "in no layer"),
    ("src/prostm/fluid/a.cpp", "#include <thread>\n", 1, "<thread>"),
    ("src/prostm/fluid/a.cpp", "#include <mutex>\n", 1, "<mutex>"),
    ("src/prostm/hand/a.cpp", "#include <condition_variable>\n", 1, "<condition_variable>"),
    ("src/prostm/core/latest.hpp", "#include <mutex>\n", 1, "<mutex>"),
    ("src/prostm/core/worker_pool.hpp", "#include <chrono>\n", 1, "<chrono>"),
    ("src/prostm/track/a.cpp", "#include <chrono>\n", 1, "<chrono>"),
    ("src/prostm/emit/a.cpp", "void f();\nstd::jthread worker;\n", 2, "std::jthread"),
    ("src/prostm/emit/a.cpp", "std::scoped_lock l(m); std::shared_mutex m;\n", 1, "std::shared_mutex"),
    ("src/prostm/plan/a.cpp", "auto t = std::chrono::steady_clock::now();\n", 1, "std::chrono"),
    ("src/prostm/plan/a.cpp", "#include <iostream>\n", 1, "<iostream>"),
    ("src/prostm/device/a.cpp", "std::cout << 1;\n", 1, "std::cout"),
    ("src/prostm/io/a.cpp", 'std::fprintf(stderr, "x");\n', 1, "fprintf"),
    ("src/prostm/io/a.cpp", 'fmt::print("x");\n', 1, "fmt::print"),
    ("src/prostm/plan/a.cpp", "#include <format>\n", 1, "<format>"),
    ("apps/prostm/a.cpp", "#include <expected>\n", 1, "<expected>"),
    ("tests/plan/a_test.cpp", "auto v = x | std::views::take(3);\n", 1, "std::views"),
    ("bench/a_bench.cpp", "auto v = x | std::ranges::views::reverse;\n", 1, "views"),
    ("apps/prostm/a.cpp", '#include "methods/tables.hpp"\n', 1, "nothing of lab, bench or tests"),
    ("apps/prostm/a.cpp", '#include "../../lab/methods/tables.hpp"\n', 1, "no header of apps/prostm/"),
    ("python/a.cpp", '\n#include "support/places.hpp"\n', 2, "no header of python/"),
    ("apps/CMakeLists.txt", "target_link_libraries(prostm PRIVATE prostm_io\n  prostm_skin_lab)\n", 2, "prostm_skin_lab is not"),
    ("apps/CMakeLists.txt", "target_link_libraries(prostm PRIVATE prostm_io prostm_rows)\n", 1, "prostm_rows is not"),
    ("python/CMakeLists.txt", "\nadd_subdirectory(../tests/fields fields)\n", 2, "../tests/fields is not"),
    ("CMakeLists.txt", GOOD["CMakeLists.txt"] + "  add_subdirectory(tests/fields)\n", 13, "tests/fields is not"),
    ("src/prostm/plan/planner_old.cpp", "\n", 1, "old copy"),
    ("src/prostm/plan/planner_v2.cpp", "\n", 1, "old copy"),
    ("src/prostm/plan/planner.cpp.bak", "\n", 1, "old copy"),
    ("docs/design_old.md", "\n", 1, "old copy"),
])
def test_finds_each_violation_at_its_place(tree, name, text, line, word):
    status, lines = check(TOOL, tree([(name, text)]))
    assert status == 1
    assert len(lines) == 1, lines
    assert lines[0].startswith(f"{name}:{line}: ")
    assert word in lines[0]


def test_finds_every_violation_of_a_file(tree):
    status, lines = check(TOOL, tree([("src/prostm/emit/a.cpp", "#include <thread>\n#include <iostream>\nstd::thread t;\n")]))
    assert status == 1
    assert [line.split(":")[1] for line in lines] == ["1", "2", "3"]


def test_a_program_may_include_stages_linked_indirectly(tree):
    files = [("apps/prostm/a.cpp", '#include "prostm/plan/plan.hpp"\n#include "prostm/core/units.hpp"\n#include "options.hpp"\n'),
             ("apps/prostm/options.hpp", ""), ("apps/prostm/run/a.cpp", '#include "options.hpp"\n#include "b.hpp"\n'),
             ("apps/prostm/run/b.hpp", "")]
    assert check(TOOL, tree(files))[0] == 0


def test_a_type_of_one_name_in_two_files_is_listed(tree):
    trial = "namespace prostm {\nstruct Trial {\n  int n;\n};\n}  // namespace prostm\n"
    own = trial.replace("struct", "namespace {\nstruct").replace("};\n", "};\n}  // namespace\n")
    root = tree([("src/prostm/plan/a.hpp", trial), ("src/prostm/score/b.hpp", trial), ("src/prostm/score/c.cpp", own)])
    assert check(TOOL, root) == (1, [
        "src/prostm/score/b.hpp:2: prostm::Trial is also the name of a type in src/prostm/plan/a.hpp:2"])


def test_a_folder_without_sources_is_an_error(tmp_path):
    result = subprocess.run([sys.executable, str(TOOL), str(tmp_path)], capture_output=True, text=True)
    assert result.returncode == 2
    assert "has no src" in result.stderr
