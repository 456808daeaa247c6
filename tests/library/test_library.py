"""The library as installed for its users: in its own folder, with programs built against that folder alone."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("PROSTM_BUILD", ROOT / "build" / "release"))
CMAKE = os.environ.get("CMAKE", "cmake")
COMPILER = os.environ.get("CXX", "c++")
EXAMPLES = ROOT / "examples"
os.environ.setdefault("CMAKE_GENERATOR", "Ninja")
# compiled quickly: only the results matter, not the speed
QUICK = ["-std=c++20", "-O0", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]


def run(*command, status=0, **options):
    """Runs a command that must end with `status`; returns its stdout, including stderr if it is to fail."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    assert done.returncode == status, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout if status == 0 else done.stdout + done.stderr


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """Returns the folder made by `cmake --install`, moved afterwards: nothing in it may refer to its first location."""
    folder = tmp_path_factory.mktemp("installed")
    run(CMAKE, "--install", BUILD, "--prefix", folder / "first")
    (folder / "first").rename(folder / "moved")
    return folder / "moved"


@pytest.fixture(scope="module")
def pkg_config(prefix):
    """Returns a function that queries pkg-config about the installed library."""
    folder = next(prefix.rglob("prostm.pc")).parent
    return lambda *what: run("pkg-config", *what, "prostm", env={**os.environ, "PKG_CONFIG_PATH": str(folder)}).split()


def configure(prefix, source, build, *options, status=0):
    return run(CMAKE, "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}",
               f"-DCMAKE_CXX_FLAGS={' '.join(QUICK[1:])}", *options, status=status)


@pytest.fixture(scope="module")
def examples(prefix, tmp_path_factory):
    """Returns a function that runs an example, built against the installed library, and returns its output."""
    build = tmp_path_factory.mktemp("examples")
    configure(prefix, EXAMPLES, build)
    run(CMAKE, "--build", build, "-j", "2")
    return lambda name: run(build / name)


def project(folder, text):
    """Creates a CMake project with one source."""
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.25)\nproject(own CXX)\n{text}\n")
    return folder


def numbers(pattern, text):
    """Returns the groups of all matches of a pattern, as numbers."""
    found = [tuple(map(float, match.groups())) for match in re.finditer(pattern, text)]
    assert found, f"{pattern} is not in:\n{text}"
    return found


def test_paths_follow_a_ring(examples):
    text = examples("01_plan")
    paths = numbers(r"(\d+) points, (\d+) mm long, ([\d.]+) ms per lap", text)
    assert text.startswith(f"{len(paths)} paths\n") and 1 <= len(paths) <= 4
    for points, length, lap in paths:
        assert 8 <= points <= 64 and 35 <= length <= 140
        assert lap == pytest.approx(length / 7.0, abs=0.15)  # at 7 m/s


def test_a_plan_beats_its_controls(examples):
    text = examples("02_quality")
    rows = {line[:36].strip(): numbers(r"correlation (-?[\d.]+)  rmse ([\d.]+)  skill (-?[\d.]+)", line)[0]
            for line in text.splitlines() if "correlation" in line}
    plan = rows.pop("plan")
    assert plan[0] > 0.9 and plan[1] < 0.15
    assert len(rows) == 3
    for correlation, _, skill in rows.values():
        assert correlation < plan[0] and skill < plan[2]
    [(plain, weighted)] = numbers(r"weighted rmse ([\d.]+), ([\d.]+) when planned with the weights", text)
    assert 0 < weighted < plain


def test_moving_points_render_better_than_points_at_rest(examples):
    text = examples("03_am")
    [(paths, moving, foci, still)] = numbers(r"correlation: (\d+) paths ([\d.]+), (\d+) foci ([\d.]+)", text)
    assert paths >= 1 and foci == 4 == len(numbers(r"focus at \((-?\d+), (-?\d+)\) mm", text))
    assert moving > 0.9 > still > 0.5


def test_a_loop_is_sampled_at_40_kHz(examples):
    text = examples("04_samples")
    [(samples, foci, loop_ms)] = numbers(r"(\d+) samples of (\d+) focal points, a loop of ([\d.]+) ms", text)
    assert loop_ms == pytest.approx(samples / 40.0, abs=0.06) and samples % 8 == 0
    points = numbers(r"starts at \((-?\d+), (-?\d+), (\d+)\) mm, (\d+) laps, intensity up to ([\d.]+)", text)
    assert len(points) == foci
    for x, y, z, laps, intensity in points:
        assert abs(x) <= 60 and abs(y) <= 60 and z == 200 and laps >= 1
        assert 0.2 < intensity <= 1.0


def test_a_custom_device_receives_segments(examples):
    text = examples("05_device")
    segments = numbers(r"320 values for (\d) focal points, the last \((-?\d+), (-?\d+), (\d+)\) mm at ([\d.]+)", text)
    assert len(segments) == 6
    assert all(foci == 4 and abs(x) <= 60 and abs(y) <= 60 and z == 200 for foci, x, y, z, _ in segments)
    assert all(segment[4] > 0.3 for segment in segments[:5]) and segments[5][4] == 0  # it stalls, then fades
    assert len({segment[1:3] for segment in segments}) > 1


def test_pkg_config_is_sufficient_for_the_compiler(pkg_config, tmp_path):
    flags = pkg_config("--cflags", "--libs")
    run(COMPILER, *QUICK, EXAMPLES / "02_quality.cpp", "-o", tmp_path / "quality", *flags)
    assert run(tmp_path / "quality").startswith("plan ")


def test_libraries_in_pkg_config_follow_those_that_need_them(pkg_config, tmp_path):
    """Even a linker that reads each library once resolves everything: this program needs all libraries."""
    (tmp_path / "all.cpp").write_text("""#include <prostm/am/am_planner.hpp>
#include <prostm/prostm.hpp>
#include <prostm/score/felt.hpp>

int main() {
  prostm::AmPlanner am({}, 4);
  prostm::device_kinds();
  prostm::FeelingSkin skin(prostm::TargetField{});
}
""")
    run(COMPILER, *QUICK, tmp_path / "all.cpp", "-o", tmp_path / "all", *pkg_config("--cflags", "--libs"))


def test_the_five_line_project_in_the_documents_builds(prefix, tmp_path):
    [text] = re.findall(r"```cmake\n(.*?)```", (ROOT / "docs" / "guides" / "cpp.md").read_text(), re.S)
    assert text.count("\n") == 5
    (tmp_path / "CMakeLists.txt").write_text(text)
    shutil.copy(EXAMPLES / "01_plan.cpp", tmp_path)
    configure(prefix, tmp_path, tmp_path / "build")
    run(CMAKE, "--build", tmp_path / "build")
    assert "paths" in run(tmp_path / "build" / "own")


def test_the_pipeline_is_a_component(prefix, tmp_path):
    source = project(tmp_path / "own", "find_package(prostm REQUIRED COMPONENTS pipeline)\n"
                     "add_executable(own own.cpp)\ntarget_link_libraries(own prostm::pipeline)")
    (source / "own.cpp").write_text("""#include <cstdio>
#include <prostm/device/simulated/simulated_array.hpp>
#include <prostm/pipeline/pipeline.hpp>

int main() {
  prostm::PipelineSettings settings;
  settings.fluid.cells = 32;
  settings.devices.of<prostm::SimulatedArraySettings>().realtime = false;
  prostm::Pipeline pipeline(settings, prostm::make_scripted_hand(settings.scripted_hand, settings.track));
  int plans = 0;
  for (int i = 0; i < 10; ++i) plans += pipeline.step(0.02) ? 1 : 0;
  std::printf("%d plans, %d samples\\n", plans, static_cast<int>(pipeline.device().samples()));
}
""")
    configure(prefix, source, tmp_path / "build")
    run(CMAKE, "--build", tmp_path / "build")
    [(plans, samples)] = numbers(r"(\d+) plans, (\d+) samples", run(tmp_path / "build" / "own"))
    assert plans == 5 and 7000 < samples <= 8400  # in 0.2 s


@pytest.mark.parametrize("text, words", [
    ("find_package(prostm REQUIRED COMPONENTS plan)", ["no component 'plan'", "the only one is pipeline"]),
    ("find_package(prostm 0.2 REQUIRED)", ["0.2", "version: 0.1"]),
    ("find_package(prostm 0.0 REQUIRED)", ["0.0", "version: 0.1"]),
])
def test_missing_components_are_reported(prefix, tmp_path, text, words):
    answer = configure(prefix, project(tmp_path / "own", text), tmp_path / "build", status=1)
    for word in words:
        assert word in re.sub(r"\s+", " ", answer)


def public_headers(prefix):
    headers = sorted((prefix / "include").rglob("*.hpp"))
    return [header.relative_to(prefix / "include") for header in headers if "detail" not in header.parts]


def test_every_public_header_compiles_against_the_installed_files(prefix, pkg_config, tmp_path):
    headers = public_headers(prefix)
    stages = {header.parts[1] for header in headers if len(header.parts) > 2}
    assert stages == {"core", "target", "acoustics", "felt", "plan", "am", "emit", "device", "score",
                      "track", "hand", "stimulus", "contact", "fluid", "pipeline"}
    flags = pkg_config("--cflags")
    for header in headers:
        (tmp_path / "one.cpp").write_text(f"#include <{header}>\n")
        needed = run(COMPILER, "-std=c++20", "-M", tmp_path / "one.cpp", *flags)
        assert str(ROOT / "src") not in needed
    (tmp_path / "all.cpp").write_text("".join(f"#include <{header}>\n" for header in headers))
    run(COMPILER, *QUICK, "-fsyntax-only", tmp_path / "all.cpp", *flags)


def test_the_version_is_the_same_everywhere(prefix, pkg_config):
    text = (prefix / "include/prostm/version.hpp").read_text()
    [version] = re.findall(r'define PROSTM_VERSION "(.*)"', text)
    parts = [re.findall(rf"define PROSTM_VERSION_{part} (\d+)", text)[0] for part in ("MAJOR", "MINOR", "PATCH")]
    assert ".".join(parts) == version
    assert pkg_config("--modversion") == [version]
    assert run(prefix / "bin/prostm", "--version").split()[0] == version
    released = re.search(r"^## \[(\d.*)\] - (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.M)
    cited = (ROOT / "CITATION.cff").read_text()
    assert released[1] == version
    assert f"version: {released[1]}\ndate-released: {released[2]}\n" in cited


def test_installed_files_refer_to_no_folder_of_the_checkout(prefix):
    for file in [*prefix.rglob("*.cmake"), *prefix.rglob("*.pc"), *prefix.rglob("*.hpp")]:
        assert str(ROOT) not in file.read_text(), file
    assert not list(prefix.rglob("*.so")) and not list(prefix.rglob("*.py")), "the Python module has its own install"


def test_a_project_that_includes_this_one_needs_only_the_planner(tmp_path):
    source = project(tmp_path / "own", f"add_subdirectory({ROOT} prostm)\n"
                     f"add_executable(own {EXAMPLES / '01_plan.cpp'})\ntarget_link_libraries(own prostm::plan)")
    answer = configure(tmp_path, source, tmp_path / "build", f"--graphviz={tmp_path / 'graph'}")
    assert "HDF5" not in answer and "OpenXR" not in answer
    assert "prostm_fluid" not in (tmp_path / "graph").read_text()
