"""Shape by Eq. (1), felt shape, felt strength and spill of a plan: plan, field and the module give the same numbers, in
text and in JSON, and in the same order."""

import json
import re

import numpy as np
import prostm
import pytest

NAMES = {"shape by Eq. (1)": "skill_0", "felt shape": "felt_skill", "felt strength": "sensation_level",
         "spill": "spill"}
PRESETS = ["best", "fast", "felt", "paper-valid"]


def bumps(seed):
    """Returns one to four bumps on skin of 24 × 20 cells, with a corner that is not skin."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:20, 0:24] * 5.0
    pressure = np.zeros_like(x)
    for _ in range(1 + seed % 4):
        centre, width = random.uniform((25, 20), (95, 80)), random.uniform(6, 18)
        pressure += random.uniform(0.4, 1) * np.exp(-((x - centre[0]) ** 2 + (y - centre[1]) ** 2) / (2 * width**2))
    pressure[:4, :4] = np.nan
    return pressure


def printed(text):
    """Returns the four numbers of a text as printed, by name, in their order."""
    pattern = "|".join(re.escape(name) for name in NAMES)
    return dict(re.findall(rf"^  ({pattern}) +(\S.*)$", text, re.MULTILINE))


def as_printed(metrics):
    """Returns the same for metrics of a file or of the module."""
    return {"shape by Eq. (1)": f"{metrics['skill_0']:.2f}", "felt shape": f"{metrics['felt_skill']:.2f}",
            "felt strength": prostm.sensation_words(metrics["sensation_level"], "usx"),
            "spill": f"{metrics['spill']:.3f}"}


@pytest.mark.parametrize("seed", range(20))
def test_numbers_of_one_name_are_equal(program, tmp_path, seed):
    np.save(tmp_path / "field.npy", bumps(seed))
    field, plan = [tmp_path / "field.npy", "--cell-mm", 5], tmp_path / "a.plan.json"
    preset = PRESETS[seed % len(PRESETS)]
    text = program("plan", *field, "--preset", preset, "--array", "usx", "--json", plan).stdout
    saved = json.loads(plan.read_text())
    expected = as_printed(saved["metrics"])
    assert list(printed(text)) == list(NAMES) and printed(text) == expected

    text = program("field", plan, "--field", *field, "--array", "usx", "--json", tmp_path / "field.json").stdout
    quality = json.loads((tmp_path / "field.json").read_text())["quality"]
    assert list(printed(text)) == list(NAMES) and printed(text) == expected == as_printed(quality)

    result = prostm.plan(tmp_path / "field.npy", preset, cell_mm=5, sigma=saved["sigma_mm"] / 1000)
    assert as_printed(result.metrics(array="usx").as_dict()) == expected


def test_a_number_with_another_definition_has_another_name(program, tmp_path):
    """The shape and the spill of the radiation pressure and of the percept are in a table of their own."""
    np.save(tmp_path / "field.npy", bumps(3))
    field, plan = [tmp_path / "field.npy", "--cell-mm", 5], tmp_path / "a.plan.json"
    program("plan", *field, "--array", "usx", "--json", plan)
    document = json.loads(program("field", plan, "--field", *field, "--json", "-").stdout)
    assert document["quality"]["spill"] != document["felt"]["metrics"]["spill"]
    assert set(NAMES.values()) <= set(document["quality"])
