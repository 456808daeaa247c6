"""tools/changed_stages.py on small repositories: the stages for which a change needs sanitizers and fuzzers."""
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "changed_stages.py"
ALWAYS = ["app", "pipeline", "viewer"]


class Checkout:
    def __init__(self, folder):
        self.folder = folder
        self.git("init", "-q")
        self.write("src/prostm/plan/plan.cpp", "src/prostm/device/device.cpp", "src/prostm/core/core.cpp", "tests/plan/plan_test.cpp",
                   "docs/design/index.md", "CMakeLists.txt", "tests/support/main.cpp")
        (folder / "tools").mkdir()
        shutil.copy(TOOL, folder / "tools")
        self.first = self.commit()

    def git(self, *arguments):
        identity = ["-c", "user.name=prostm", "-c", "user.email=prostm@localhost"]
        return subprocess.run(["git", "-C", self.folder, *identity, *arguments], check=True, capture_output=True,
                              text=True).stdout.strip()

    def write(self, *paths):
        for path in paths:
            (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
            with open(self.folder / path, "a") as file:
                file.write("more\n")

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "change", "--allow-empty")
        return self.git("rev-parse", "HEAD")

    def stages(self, since):
        tool = [sys.executable, self.folder / "tools/changed_stages.py", since]
        return subprocess.run(tool, check=True, capture_output=True, text=True).stdout.splitlines()


@pytest.fixture
def checkout(tmp_path):
    return Checkout(tmp_path)


def test_a_change_selects_its_stage(checkout):
    checkout.write("src/prostm/plan/plan.cpp")
    checkout.commit()
    assert checkout.stages(checkout.first) == sorted(ALWAYS + ["plan"])
    checkout.write("src/prostm/device/device.cpp")  # not committed
    checkout.write("tests/core/new_test.cpp")  # untracked
    assert checkout.stages(checkout.first) == sorted(ALWAYS + ["plan", "device", "ultraleap", "core"])


def test_files_outside_the_sanitizers_select_only_what_always_runs(checkout):
    checkout.write("docs/design/index.md", "web/src/main.ts", "tests/python/test_am.py", "tests/library/test_library.py")
    checkout.commit()
    assert checkout.stages(checkout.first) == ALWAYS


@pytest.mark.parametrize("path", ["CMakeLists.txt", "tests/support/main.cpp", "tools/fuzz.sh", "run", "fuzz/a_fuzz.cpp",
                                  "src/prostm/fields/fields.cpp"])
def test_shared_files_select_all_stages(checkout, path):
    checkout.write("src/prostm/plan/plan.cpp", path)
    checkout.commit()
    assert checkout.stages(checkout.first) == []


def test_a_commit_that_is_not_an_ancestor_selects_all_stages(checkout):
    checkout.git("checkout", "-q", "-b", "other")
    checkout.write("src/prostm/core/core.cpp")
    other = checkout.commit()
    checkout.git("checkout", "-q", "-")
    assert checkout.stages(other) == checkout.stages("") == checkout.stages("0" * 40) == []
