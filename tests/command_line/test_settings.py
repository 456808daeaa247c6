"""prostm settings lists the entries of a settings file, and writes a file that can be read."""

import json
import re
import tomllib

import pytest


def listed(prostm, *arguments):
    document = json.loads(prostm("settings", *arguments, "--json", "-").stdout)
    assert document["format"] == "prostm-settings/1"
    return document["settings"]


def test_every_setting_is_explained(prostm):
    rows = listed(prostm)
    groups = list(dict.fromkeys(row["group"] for row in rows))
    assert groups == ["pipeline", "track", "scripted_hand", "study_hand", "fluid", "box", "jets", "contact", "plan", "am",
                      "emit", "safety", "simulated_array", "autd3", "stream"]
    names = [(row["group"], row["name"]) for row in rows]
    assert len(names) == len(set(names)) > 80
    for row in rows:
        assert len(row["help"]) >= 8 and not re.match("(of|the same) ", row["help"]), row
        assert row["value"] == row["default"]
        if row["type"] in ("integer", "float"):
            assert row["least"] <= row["value"] <= row["most"], row
            assert isinstance(row["least"], int if row["type"] == "integer" else float)
        else:
            assert row["least"] is None and row["most"] is None
        if row["choices"]:
            assert row["type"] == "string" and row["value"] in row["choices"]


def test_the_table(prostm):
    text = prostm("settings").stdout
    rows = listed(prostm)
    assert all(len(line) <= 120 and line == line.rstrip() for line in text.splitlines())
    assert [f"[{g}]" for g in dict.fromkeys(r["group"] for r in rows)] == re.findall(r"^\[\w+\]$", text, re.M)
    assert [row["name"] for row in rows] == re.findall(r"^  (\w+) +(?!range)[^ ]", text, re.M)[1:]
    # every row has its complete description
    flat = " ".join(text.split())
    assert all(row["help"].split()[0] in flat for row in rows)
    assert "paths 4 1 to 8 largest number of paths" in flat
    assert "speed 7 0.1 to 8 m/s speed of the focal points (v)" in flat


def test_a_single_group_and_key(prostm, refuses):
    assert {row["group"] for row in listed(prostm, "plan")} == {"plan"}
    assert [row["name"] for row in listed(prostm, "plan.paths")] == ["paths"]
    assert [row["group"] for row in listed(prostm, "sigma")] == ["plan", "am"]
    text = prostm("settings", "plan.paths").stdout
    assert "[plan]" in text and "[am]" not in text and text.count("\n") == 4
    refuses("settings", "plam", words=['there is no setting or group of settings "plam"', 'did you mean "plan"?'])
    refuses("settings", "plan.pathz", words=['plan has no setting "pathz"; did you mean "paths"?'])
    refuses("settings", "plam.paths", words=['there is no group of settings "plam"; did you mean "plan"?'])
    refuses("settings", "xyzzy", words=["the groups are pipeline, track"])


def test_the_values_in_force(prostm, refuses, tmp_path):
    (tmp_path / "s.toml").write_text("[plan]\nsigma = 4e-3\n[emit]\nswitch_at = \"now\"\n")
    options = ["--settings", "s.toml", "--preset", "fast"]
    changed = {(r["group"], r["name"]): (r["value"], r["default"]) for r in listed(prostm, *options)
               if r["value"] != r["default"]}
    assert changed == {("plan", "sigma"): (0.004, 0.0086), ("plan", "preset"): ("fast", "best"),
                       ("emit", "switch_at"): ("now", "lap")}
    text = prostm("settings", *options).stdout
    assert "(default 0.0086)" in text and '(default "best")' in text
    refuses("settings", "--preset", "fats", words=['did you mean "fast"?'])
    assert "wrote s.json" in prostm("settings", "--json", "s.json").stdout


def test_the_settings_file_can_be_read_unchanged_and_with_every_key(prostm, refuses, tmp_path):
    text = prostm("settings", "--toml").stdout
    assert all(not table for table in tomllib.loads(text).values())
    (tmp_path / "as-is.toml").write_text(text)
    every = re.sub(r"^#(\w+ = )", r"\1", text, flags=re.M)
    (tmp_path / "every.toml").write_text(every)
    rows = listed(prostm)
    assert sum(len(table) for table in tomllib.loads(every).values()) == len(rows)
    for row in rows:
        assert tomllib.loads(every)[row["group"]][row["name"]] == row["default"]
        assert f"# {row['help']}" in text
    for name in ("as-is.toml", "every.toml"):
        assert listed(prostm, "--settings", name) == rows

    # values that differ from the defaults are set
    text = prostm("settings", "plan", "--toml", "--paths", "2").stdout
    assert tomllib.loads(text) == {"plan": {"paths": 2}}
    refuses("settings", "--toml", "--json", "-", words=["exclude each other"])


@pytest.mark.parametrize("text", ["", "\n", "# nothing yet\n"])
def test_a_settings_file_may_be_empty(prostm, tmp_path, text):
    (tmp_path / "empty.toml").write_text(text)
    assert listed(prostm, "--settings", "empty.toml") == listed(prostm)
