"""prostm experiments: published experiments, predictions, the fit."""

import json

import pytest

from conftest import ROOT


def test_an_experiment_is_printed_with_published_and_predicted_numbers(prostm):
    result = prostm("experiments", "howard-2023", "--model", "peak")
    assert "howard-2023: Gap of two focal points (fit)" in result.stdout
    assert "participants: not in the abstract" in result.stdout
    assert "peak, template" in result.stdout and "peak, category" in result.stdout
    assert "area" not in result.stdout
    assert "Parameters: SHA-256 " in result.stdout


def test_json_has_every_number_with_its_source(prostm, tmp_path):
    prostm("experiments", "wilson-2014", "howard-2023", "--readout", "template", "--json", "out.json")
    document = json.loads((tmp_path / "out.json").read_text())
    assert len(document["parameters_sha256"]) == 64
    observers = {entry["observer"]: entry for entry in document["observers"]}
    assert "guess" in observers and "no-skin, template" in observers
    cell = observers["peak, template"]["experiments"][1]["cells"][0]
    assert cell["published"] == 8.5 and cell["source"] == "text"
    assert cell["low"] <= cell["predicted"] <= cell["high"] and cell["within"]
    # a guess predicts nothing, and is scored
    guess = observers["guess"]["experiments"][1]["cells"][0]
    assert guess["predicted"] is None and guess["loss"] == 2.0


def test_predictions_are_the_same_each_time(prostm):
    texts = [prostm("experiments", "alexander-2011", "--model", "area").stdout for _ in range(2)]
    assert texts[0] == texts[1]


@pytest.mark.long
def test_the_frozen_parameters_are_those_of_the_fit(prostm, tmp_path):
    prostm("experiments", "--fit", "fitted.json", "--model", "peak")
    fitted = json.loads((tmp_path / "fitted.json").read_text())
    frozen = json.loads((ROOT / "data/psychophysics/observers.json").read_text())
    assert fitted["fitted_to"] == frozen["fitted_to"]
    for now, before in zip(fitted["observers"], frozen["observers"][:2], strict=True):
        assert (now["model"], now["readout"]) == (before["model"], before["readout"])
        for name in ("threshold", "noise", "criterion", "strength_noise"):
            assert now[name]["value"] == pytest.approx(before[name]["value"], rel=1e-6), name


@pytest.mark.long
def test_leaving_a_paper_out_shows_what_it_determines(prostm):
    lines = prostm("experiments", "--leave-one-out", "--model", "peak", "--readout", "template").stdout.splitlines()
    assert len(lines) == 5
    without = {line.split(" without ")[1].split(":")[0]: line for line in lines}
    assert "threshold is not determined" in without["dalecki"]
    assert "criterion is not determined" in without["howard"]
    assert "noise is not determined; l" not in without["wilson"].replace("strength_noise", "")


@pytest.mark.long
def test_a_figure_is_drawn(prostm, tmp_path):
    sizes = []
    for names in (["howard-2023"], ["howard-2023", "wilson-2014"]):
        prostm("experiments", *names, "--model", "peak", "--figure", "figure.svg")
        sizes.append(len((tmp_path / "figure.svg").read_text()))
    assert 10_000 < sizes[0] < sizes[1]  # a chart for each experiment


@pytest.mark.parametrize("arguments, sentence", [
    (["howard-2013"], 'there is no experiment "howard-2013"; did you mean "howard-2023"?'),
    (["--model", "peek"], "--model must be peak, area"),
    (["--readout", "both"], "--readout must be template or category"),
    (["--set", "all"], "--set must be fit or held-out"),
    (["howard-2023", "--set", "held-out"], "no experiment of --set held-out is named"),
    (["howard-2023", "--fit", "f.json"], "exclude each other"),
    (["--fit", "f.json", "--json", "-"], "exclude each other"),
    (["--leave-one-out", "--figure", "f.png"], "exclude each other"),
])
def test_unknown_names_get_a_sentence(refuses, arguments, sentence):
    refuses("experiments", *arguments, words=[sentence])
