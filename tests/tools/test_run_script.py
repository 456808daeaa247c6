"""The reports and checks of ./run before long work: its functions, sourced by a shell, with stand-ins for apt."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

TOOLS = ["bash", "awk", "basename", "cat", "dirname", "env", "grep", "mkdir", "nproc", "readlink", "sed", "tail", "tr"]


class Shell:
    """A checkout that contains only `run`, and a PATH with a few tools and stand-ins."""

    def __init__(self, folder):
        self.root = folder / "checkout"
        self.programs = folder / "programs"
        self.root.mkdir()
        self.programs.mkdir()
        shutil.copy(ROOT / "run", self.root)
        for tool in TOOLS:
            (self.programs / tool).symlink_to(shutil.which(tool))

    def stand_in(self, name, script):
        path = self.programs / name
        path.write_text(f"#!{shutil.which('bash')}\n{script}\n")
        path.chmod(0o755)

    def call(self, commands, status=0):
        done = subprocess.run([shutil.which("bash"), "-c", f'. "{self.root}/run"\n{commands}'], text=True, cwd="/",
                              env={"PATH": str(self.programs)}, capture_output=True, timeout=60)
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout if status == 0 else done.stderr


@pytest.fixture
def shell(tmp_path):
    return Shell(tmp_path)


APT_ASKS = """\
Reading package lists...
The following NEW packages will be installed:
  one two
0 upgraded, 631 newly installed, 0 to remove and 5 not upgraded.
Need to get 12.5 MB/420 MB of archives.
After this operation, 1,994 MB of additional disk space will be used.
Do you want to continue? [Y/n] N
Abort."""


def test_the_size_of_an_installation_is_reported_in_aptitudes_own_numbers(shell):
    told = shell.call(f"size_of_install <<'END'\n{APT_ASKS}\nEND")
    assert told == "631 packages with all that they need, 12.5 MB to download, 1,994 MB on the disk"
    assert "420 MB to download" in shell.call("size_of_install <<<'Need to get 420 MB of archives.'")


@pytest.fixture
def with_apt(shell):
    """A Debian on which `there` is installed; the caller is root."""
    shell.stand_in("dpkg-query", "echo installed there")
    shell.stand_in("id", "echo 0")
    shell.stand_in("apt-get", f'echo "$*" >>{shell.root}/apt.calls\n[[ $* != *assume-no* ]] || cat <<END\n{APT_ASKS}\nEND')
    return shell


def test_each_missing_package_is_named_once_with_the_total_size(with_apt):
    told = with_apt.call("install there one two one")
    assert told.splitlines()[:2] == [
        "run: missing: one two",
        "run: installing 631 packages with all that they need, 12.5 MB to download, 1,994 MB on the disk"]
    assert (with_apt.root / "apt.calls").read_text().splitlines()[-1].endswith("install --no-install-recommends one two")


def test_nothing_is_fetched_if_nothing_is_missing(with_apt):
    assert with_apt.call("install there") == ""
    assert not (with_apt.root / "apt.calls").exists()


def test_without_sudo_the_whole_command_is_printed(with_apt):
    with_apt.stand_in("id", "echo 1000")
    told = with_apt.call("install there one two", status=2)
    assert told == ("run: packages are missing and there is no sudo; as root run: "
                    "apt-get update && apt-get install --no-install-recommends one two\n")


@pytest.mark.parametrize("version, wanted", [("v18.20.4", ""), ("v16.20.2", "nodejs npm"), (None, "nodejs npm")])
def test_node_is_installed_only_if_no_suitable_version_exists(shell, version, wanted):
    shell.stand_in("npm", "")
    if version:
        shell.stand_in("node", f"echo {version}")
    assert shell.call("packages_of_node").split() == wanted.split()


def test_the_program_and_its_page_need_one_round_of_packages(with_apt):
    told = with_apt.call("install_for_program extra")
    assert told.count("run: missing: ") == 1
    missing = told.splitlines()[0].split()[2:]
    assert {"cmake", "nodejs", "npm", "extra"} <= set(missing) and len(missing) == len(set(missing))


def test_npm_downloads_are_announced_once(with_apt):
    (with_apt.root / "web/node_modules").mkdir(parents=True)
    lock, installed = with_apt.root / "web/package-lock.json", with_apt.root / "web/node_modules/.package-lock.json"
    lock.touch()
    assert "npm registry" in with_apt.call("install_for_program")
    installed.touch()
    os.utime(lock, (1, 1))
    assert "npm registry" not in with_apt.call("install_for_program")


def test_a_build_folder_from_elsewhere_is_reported_with_the_remedy(shell):
    cache = shell.root / "build/release/CMakeCache.txt"
    cache.parent.mkdir(parents=True)
    shell.call("check_place asan")  # does not exist yet
    cache.write_text(f"CMAKE_CACHEFILE_DIR:INTERNAL={cache.parent}\n")
    shell.call("check_place release")
    cache.write_text("CMAKE_CACHEFILE_DIR:INTERNAL=/elsewhere/build/release\n")
    told = shell.call("check_place release", status=2)
    assert "made in another folder (/elsewhere/build/release)" in told
    assert f"rm -r {shell.root}/build/release" in told.replace("'", "")


LOG = """\
Start testing: now
----------------------------------------------------------
1/3 Testing: track.LeapClient.Arrives
1/3 Test: track.LeapClient.Arrives
Output:
----------------------------------------------------------
[ RUN      ] LeapClient.Arrives
/src/tests/track/leap_client_test.cpp:76: Skipped
needs data/leap/flapping.json in ../shared, which is not part of the project

[  SKIPPED ] LeapClient.Arrives (0 ms)
2/3 Testing: track.OpenXr.Arrives
2/3 Test: track.OpenXr.Arrives
/src/tests/track/openxr_hands_test.cpp:76: Skipped
needs data/leap/flapping.json in ../shared, which is not part of the project
3/3 Testing: command_line
.....s..                                                                 [100%]
SKIPPED [1] tests/command_line/test_x.py:12: too slow here
7 passed, 1 skipped in 3.00s
4/4 Testing: prose
4/4 Test: prose
skipped: there is no Vale
"""


# builds nothing: prints what it would configure and build, and what ctest would run
DRY = """
install_for_program() { :; }
configure() { echo "configure $1"; }
build_targets() { echo "build $*"; }
cmake() { :; }
ctest() { echo "ctest $*"; }
rm() { :; }
mkdir -p "$root/build"
"""


def test_a_part_of_full_makes_only_its_own_build(shell):
    told = shell.call(f"{DRY}run_tests --full --only=asan").splitlines()
    assert told[:3] == ["configure release", "configure asan", "build asan all"]
    assert told[3].endswith("-R ^asan\\.") and len(told) == 4
    (shell.root / "fuzz").mkdir()
    (shell.root / "fuzz/plan_json_fuzz.cpp").write_text('#include "prostm/io/plan_file.hpp"\n')
    told = shell.call(f"{DRY}run_tests --full --only=fuzz").splitlines()
    assert told[:3] == ["configure release", "configure asan", "build asan plan_json_fuzz"] and len(told) == 4
    told = shell.call(f"{DRY}run_tests --full --only=checks").splitlines()
    assert told[0] == "configure release" and told[1].startswith("ctest ") and len(told) == 2


def test_full_makes_all_builds(shell):
    told = shell.call(f"{DRY}run_tests --full -N").splitlines()
    assert [line for line in told if line.startswith("configure")] == [
        "configure release", "configure asan", "configure tsan"]
    assert "build release all" in told


@pytest.mark.parametrize("options, says", [
    ("--full --only=ubsan", "test --only has no part 'ubsan'; there are: asan, tsan, fuzz, checks"),
    ("--only=asan", "test --changed and --only belong to --full"),
    ("--changed", "test --changed and --only belong to --full"),
])
def test_an_unknown_or_lone_part_is_rejected(shell, options, says):
    assert says in shell.call(f"{DRY}run_tests {options}", status=2)


def test_skipped_tests_are_listed_with_their_reasons(tmp_path):
    log = tmp_path / "LastTest.log"
    log.write_text(LOG)
    tool = [sys.executable, ROOT / "tools/skipped_tests.py"]
    told = subprocess.run([*tool, log], check=True, capture_output=True, text=True).stdout.splitlines()
    assert told == [
        "skipped: needs data/leap/flapping.json in ../shared, which is not part of the project: "
        "track.LeapClient.Arrives, track.OpenXr.Arrives",
        "skipped: too slow here: tests/command_line/test_x.py:12",
        "skipped: there is no Vale: prose"]
    assert subprocess.run([*tool, tmp_path / "none"], capture_output=True).returncode == 2
