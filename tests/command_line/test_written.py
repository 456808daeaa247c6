"""Every command names the files it wrote, on the stream of its prose."""

import json

import pytest

from test_bad_input import foci_file
from test_commands import blob_field


@pytest.fixture
def field(tmp_path):
    path = tmp_path / "blob.json"
    path.write_text(json.dumps(blob_field()))
    return path


def written(done):
    return [line for line in done.stdout.splitlines() if line.startswith("wrote ")]


@pytest.mark.long
def test_plan_field_and_solve_name_their_files(prostm, field, tmp_path):
    assert written(prostm("plan", field)) == []
    done = prostm("plan", field, "--json", "plan.json", "--figure", "plan.svg")
    assert written(done) == ["wrote plan.svg", "wrote plan.json"]
    done = prostm("field", "plan.json", "--json", "field.json", "--figure", "field.svg")
    assert written(done) == ["wrote field.svg", "wrote field.json"]
    assert written(prostm("field", "--widths", "--json", "widths.json")) == ["wrote widths.json"]
    done = prostm("solve", foci_file(tmp_path, [0, 0, 200]), "--json", "drives.json")
    assert written(done) == ["wrote drives.json"]
    assert all((tmp_path / name).is_file() for name in ("plan.svg", "plan.json", "field.json", "drives.json"))


def test_capture_and_bench_name_their_files(prostm):
    done = prostm("capture", "--grid", "32", "--frames", "2", "--out", "a.h5", "--json", "capture.json")
    assert written(done) == ["wrote a.h5", "wrote capture.json"]
    done = prostm("bench", "a.h5", "--repeats", "1", "--json", "bench.json")
    assert written(done) == ["wrote bench.json"]


def test_standard_output_is_not_named_as_a_file(prostm, field):
    done = prostm("plan", field, "--json", "-", "--figure", "plan.svg")
    json.loads(done.stdout)
    assert [line for line in done.stderr.splitlines() if line.startswith("wrote ")] == ["wrote plan.svg"]
