"""prostm plan describes how it read a field, evaluates its plan in a sentence, and warns about likely mistakes."""

import json

import h5py
import numpy as np
import pytest

from pictures import write_grey_png
from test_commands import blob_field


def drawing(side=40):
    """Two blots of ink on white paper: grey values, top row first."""
    y, x = np.mgrid[0:side, 0:side]
    ink = np.exp(-((x - 13) ** 2 + (y - 15) ** 2) / 30) + np.exp(-((x - 27) ** 2 + (y - 24) ** 2) / 40)
    return np.round(255 * (1 - np.clip(ink, 0, 1))).astype(np.uint8)


def planned(prostm, *arguments):
    """The lines of prose, and the plan."""
    done = prostm("plan", *arguments, "--json", "-")
    return done.stderr.splitlines(), json.loads(done.stdout)


def warnings_in(lines):
    return [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]


def test_describes_what_was_read(prostm, tmp_path):
    field = blob_field()
    (tmp_path / "blob.json").write_text(json.dumps(field))
    lines, plan = planned(prostm, "blob.json")
    largest = np.max(field["pressure"])
    assert lines[0] == (f"blob.json: 150 × 120 mm, 30 × 24 cells of 5 mm, all skin; largest pressure {largest:.3g} "
                        "in the file's unit")
    assert plan["warnings"] == [] == warnings_in(lines)

    holes = np.array(field["pressure"])
    holes[:, :15] = np.nan
    np.save(tmp_path / "half.npy", holes)
    assert "75 × 60 mm, 30 × 24 cells of 2.5 mm, 50 % skin;" in planned(prostm, "half.npy", "--width-mm", "75")[0][0]

    prostm("capture", "--grid", "32", "--frames", "1", "--out", "a.h5")
    line = planned(prostm, "a.h5")[0][0]
    assert line.startswith("a.h5, frame 0: ") and line.endswith(" Pa")


def test_the_verdict_precedes_the_numbers(prostm, tmp_path):
    (tmp_path / "blob.json").write_text(json.dumps(blob_field()))
    lines, plan = planned(prostm, "blob.json")
    skill = plan["metrics"]["skill_0"]
    assert lines[1].startswith(f"{len(plan['paths'])} paths render this field; ")
    assert lines[2] == f"  shape by Eq. (1)   {skill:.2f}"
    lines, plan = planned(prostm, "blob.json", "--method", "am", "--paths", "1")
    assert "1 focus renders this field; " in "\n".join(lines)
    np.save(tmp_path / "even.npy", np.full((8, 8), 3.0))
    lines, plan = planned(prostm, "even.npy", "--cell-mm", "5")
    assert f"this even field with an error (RMSE) of {plan['metrics']['rmse']:.2f} of its pressure" in lines[1]


def test_a_photo_is_not_a_drawing(prostm, tmp_path):
    y, x = np.mgrid[0:40, 0:40] / 39.0
    photo = np.uint8(90 + 60 * np.sin(5 * x + 2 * y) + 50 * np.cos(3 * x * y) + 40 * y)
    write_grey_png(tmp_path / "photo.png", photo)
    lines, _ = planned(prostm, "photo.png", "--width-mm", "120")
    told = " ".join(warnings_in(lines))
    assert "a photo presses nearly everywhere" in told and "--invert" not in told


def test_ink_on_white_paper(prostm, tmp_path):
    write_grey_png(tmp_path / "ink.png", drawing())
    lines, plan = planned(prostm, "ink.png", "--width-mm", "120")
    assert lines[0].endswith("all skin; largest pressure 1 of full scale, white is full scale and black is no pressure")
    told = warnings_in(lines)
    assert any("black on white; try --invert" in warning for warning in told) and plan["warnings"] == told

    lines, plan = planned(prostm, "ink.png", "--width-mm", "120", "--invert")
    assert lines[0] == ("ink.png: 120 × 120 mm, 40 × 40 cells of 3 mm, all skin; largest pressure 1 of full scale, "
                        "black is full scale and white is no pressure")
    assert plan["warnings"] == warnings_in(lines) == [] and plan["metrics"]["skill_0"] > 0.5

    # same as an image of the other kind, for which an inversion would be wrong
    write_grey_png(tmp_path / "light.png", 255 - drawing())
    light = planned(prostm, "light.png", "--width-mm", "120")[1]
    assert light["paths"] == plan["paths"]
    spoiled = planned(prostm, "light.png", "--width-mm", "120", "--invert")[1]
    assert any("try without --invert" in warning for warning in spoiled["warnings"])


@pytest.mark.parametrize("grey", [255, 90, 0])
@pytest.mark.parametrize("options", [[], ["--invert"]])
def test_a_uniform_image_has_nothing_to_plan(prostm, tmp_path, grey, options):
    write_grey_png(tmp_path / "even.png", np.full((12, 12), grey, np.uint8))
    told = warnings_in(planned(prostm, "even.png", "--width-mm", "60", *options)[0])
    assert told == ["the picture is the same everywhere, so it has no shape to plan"]


def test_ink_on_a_transparent_ground(prostm, tmp_path):
    y, x = np.mgrid[0:24, 0:24]
    ring = np.abs(np.hypot(x - 12, y - 12) - 7) < 2
    for name, ink in ("black", 0), ("white", 255):
        pixels = np.stack([np.full(ring.shape, ink), 255 * ring], axis=-1)
        write_grey_png(tmp_path / f"{name}.png", pixels.astype(np.uint8))
    lines, plan = planned(prostm, "black.png", "--width-mm", "100")
    assert plan["paths"] == [] and warnings_in(lines) == plan["warnings"] == [
        "the picture is black wherever it is not transparent, and black means no pressure; try --invert, and fill the "
        "transparent background with white if it should be skin too"]
    lines, plan = planned(prostm, "black.png", "--width-mm", "100", "--invert")
    [alone] = plan["warnings"]
    assert len(plan["paths"]) > 0 and "its shape lies only in its transparency" in alone
    assert planned(prostm, "white.png", "--width-mm", "100")[1]["warnings"] == [alone]
    [warning] = planned(prostm, "white.png", "--width-mm", "100", "--invert")[1]["warnings"]
    assert "white means no pressure; try without --invert" in warning and "background with black" in warning
    write_grey_png(tmp_path / "clear.png", np.zeros((12, 12, 2), np.uint8))
    assert planned(prostm, "clear.png", "--width-mm", "100")[1]["warnings"] == [
        "the picture is transparent everywhere, and transparent means no skin"]


def test_a_frame_without_a_hand_names_the_first_with_one(prostm, refuses, tmp_path):
    prostm("capture", "--grid", "32", "--frames", "3", "--out", "a.h5")
    with h5py.File(tmp_path / "a.h5", "r+") as file:
        file["frame/patches"][:2] = 0
    refuses("plan", "a.h5", words=[
        "a.h5: frame 0 holds no hand; the first frame with a hand is 2, choose it with --frame"])
    prostm("plan", "a.h5", "--frame", "2")
    with h5py.File(tmp_path / "a.h5", "r+") as file:
        file["frame/patches"][:] = 0
    refuses("plan", "a.h5", "--frame", "1", words=["a.h5 holds no hand in any frame"])


def test_larger_than_a_hand(prostm, tmp_path):
    pressure = np.array(blob_field()["pressure"])
    np.save(tmp_path / "blob.npy", pressure)
    [warning] = [w for w in planned(prostm, "blob.npy", "--cell-mm", "10")[1]["warnings"] if "hand" in w]
    assert warning == "the field is 300 × 240 mm, larger than a hand; try --width-mm 200"
    assert not any("hand" in w for w in planned(prostm, "blob.npy", "--width-mm", "200")[1]["warnings"])
    # only skin counts
    pressure[:, 20:] = np.nan
    np.save(tmp_path / "part.npy", pressure)
    assert not any("hand" in w for w in planned(prostm, "part.npy", "--cell-mm", "10")[1]["warnings"])
    large = blob_field()
    large["cell_mm"] = 10
    (tmp_path / "large.json").write_text(json.dumps(large))
    [warning] = [w for w in planned(prostm, "large.json")[1]["warnings"] if "hand" in w]
    assert warning == "the field is 300 × 240 mm, larger than a hand"


@pytest.mark.long
def test_a_plan_that_loses_to_a_control(prostm, tmp_path):
    # white paper with a little ink: more than a few paths can render
    write_grey_png(tmp_path / "page.png", drawing(60))
    lines, plan = planned(prostm, "page.png", "--cell-mm", "10")
    [loss] = [w for w in plan["warnings"] if "loses" in w]
    best = max(plan["controls"], key=lambda control: control["metrics"]["skill_0"])
    assert f'loses to the control "{best["name"]}", shape by Eq. (1) {plan["metrics"]["skill_0"]:.2f} against ' in loss
    assert lines.index(f"warning: {loss}") == 1 + lines.index(next(x for x in lines if x.startswith("  spill ")))


def test_impossible_sizes(refuses, tmp_path):
    np.save(tmp_path / "a.npy", np.ones((4, 5)))
    (tmp_path / "a.json").write_text(json.dumps(blob_field()))
    refuses("plan", "a.npy", "--cell-mm", "5", "--width-mm", "20", words=["--cell-mm and --width-mm exclude each other"])
    refuses("plan", "a.npy", "--width-mm", "0", words=["--width-mm 0 over 5 columns"])
    refuses("plan", "a.npy", "--width-mm", "20", "--invert", words=["a.npy is not a picture; leave out --invert"])
    refuses("plan", "a.json", "--width-mm", "20", words=["contains the size of a cell", "--width-mm"])
    refuses("plan", "a.npy", words=["--cell-mm", "--width-mm"])


@pytest.mark.long
def test_field_reads_an_image_like_plan(prostm, tmp_path):
    write_grey_png(tmp_path / "ink.png", drawing(20))
    picture = ["ink.png", "--width-mm", "80", "--invert"]
    prostm("plan", *picture, "--json", "plan.json")
    done = prostm("field", "plan.json", "--field", *picture, "--json", "-")
    assert json.loads(done.stdout)["envelope"]["metrics"]["correlation"] > 0.2


@pytest.mark.long
def test_the_spectrum_of_the_felt_field(prostm, tmp_path):
    (tmp_path / "blob.json").write_text(json.dumps(blob_field()))
    prostm("plan", "blob.json", "--preset", "fast", "--json", "blob.plan.json")
    done = prostm("field", "blob.plan.json", "--felt-spectrum", "--json", "-")
    felt = json.loads(done.stdout)["felt"]
    spectrum = felt["spectrum"]
    assert sum(h["share_at_strongest"] for h in spectrum) == pytest.approx(1)
    assert sum(h["share_of_intensity"] for h in spectrum) == pytest.approx(1)
    frequencies = [h["frequency_hz"] for h in spectrum]
    assert frequencies == pytest.approx([(n + 1) * frequencies[0] for n in range(len(spectrum))])
    assert frequencies[-1] <= 1000 < frequencies[-1] + frequencies[0]
    for h in spectrum:
        omega = 2 * np.pi * h["frequency_hz"]
        assert h["strongest_mm_s"] == pytest.approx(1e-3 * omega * h["strongest_um"])
    rows = [line.split() for line in done.stderr.splitlines()]
    loudest = max(spectrum, key=lambda h: h["share_at_strongest"])
    assert [f"{loudest['frequency_hz']:.1f}", f"{loudest['share_at_strongest']:.4f}"] in [row[:2] for row in rows]
    assert json.loads(prostm("field", "blob.plan.json", "--json", "-").stdout)["felt"]["spectrum"] is None
    refused = prostm("field", "--widths", "--felt-spectrum", status=2)
    assert refused.stderr == "prostm: --felt-spectrum needs a plan; --widths has no percept\n"
