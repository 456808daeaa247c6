"""Fields in files of other programs: archives, frames of arrays, rounding, images of 16 bits, standard input, long names,
and how to convert formats that are not supported."""

import json
import struct
import subprocess
import zlib

import numpy as np
import pytest

BLOB = np.exp(-np.hypot(*np.mgrid[-6:7, -5:6]) ** 2 / 9)
SIZE = ["--cell-mm", "5", "--preset", "fast"]


def pressures_of(prostm, *arguments):
    """Returns the first line that plan prints about a field, and the field's largest pressure."""
    lines = prostm("plan", *arguments, *SIZE).stdout.splitlines()
    return lines[0], float(lines[0].split("largest pressure ")[1].split()[0])


def write_png(path, depth, colour, rows):
    """rows: the bytes of each row, top row first."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    header = struct.pack(">IIBBBBB", len(rows[0]) // (channels * depth // 8), len(rows), depth, colour, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                     chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))


def test_archives_of_arrays(prostm, refuses, tmp_path):
    np.savez(tmp_path / "one.npz", BLOB)
    np.savez_compressed(tmp_path / "several.npz", x=np.arange(3), weak=0.25 * BLOB, frames=np.stack([BLOB, 3 * BLOB]))
    assert pressures_of(prostm, "one.npz")[1] == 1
    assert pressures_of(prostm, "several.npz", "--variable", "weak")[1] == 0.25
    line, largest = pressures_of(prostm, "several.npz", "--variable", "frames", "--frame", "1")
    assert largest == 3 and line.startswith("several.npz, frame 1: ")
    refuses("plan", "several.npz", *SIZE, words=["holds 3 arrays; choose one with --variable: x, weak, frames"])
    refuses("plan", "several.npz", *SIZE, "--variable", "weka", words=["has no array \"weka\"", "x, weak, frames"])
    refuses("plan", "several.npz", *SIZE, "--variable", "x", words=["several.npz, array x", "1 dimensions"])
    np.save(tmp_path / "a.npy", BLOB)
    refuses("plan", "a.npy", *SIZE, "--variable", "x", words=["leave out --variable"])
    whole = (tmp_path / "several.npz").read_bytes()
    for size in (0, 10, 200, len(whole) // 2, len(whole) - 5):
        (tmp_path / "cut.npz").write_bytes(whole[:size])
        refuses("plan", "cut.npz", *SIZE, "--variable", "weak", words=["cut.npz"])
    changed = bytearray((tmp_path / "one.npz").read_bytes())
    changed[200] ^= 1
    (tmp_path / "changed.npz").write_bytes(changed)
    refuses("plan", "changed.npz", *SIZE, words=["truncated or damaged"])


@pytest.mark.parametrize("order", "CF")
@pytest.mark.parametrize("kind", ["<f2", ">f2", "<f4", ">f4", ">f8", ">i2"])
def test_numbers_of_every_kind_and_order(prostm, tmp_path, kind, order):
    field = np.asarray(np.round(64 * BLOB), kind, order)
    field[0, 1] = 3
    np.save(tmp_path / "a.npy", field)
    prostm("plan", "a.npy", *SIZE, "--json", "a.json")
    np.save(tmp_path / "b.npy", field.astype("float64", order="C"))
    prostm("plan", "b.npy", *SIZE, "--json", "b.json")
    a, b = (json.loads((tmp_path / name).read_text()) for name in ("a.json", "b.json"))
    assert a["paths"] == b["paths"] and len(a["paths"]) > 0


def test_frames_of_an_array(prostm, refuses, tmp_path):
    np.save(tmp_path / "a.npy", np.stack([BLOB, 2 * BLOB, 4 * BLOB]))
    assert pressures_of(prostm, "a.npy", "--frame", "2")[1] == 4
    refuses("plan", "a.npy", *SIZE, words=["3 frames of 13 x 11 cells", "--frame, 0 to 2"])
    refuses("plan", "a.npy", *SIZE, "--frame", "3", words=["no frame 3"])


def test_rounding_errors_of_a_solver_are_not_suction(prostm, refuses, tmp_path):
    field = BLOB.copy()
    field[0, 0] = -1e-18
    np.save(tmp_path / "a.npy", field)
    assert pressures_of(prostm, "a.npy")[1] == 1
    document = {"format": "prostm-field/1", "cell_mm": 5, "origin_mm": [0, 0], "rows": 13, "cols": 11,
                "pressure": field.tolist()}
    (tmp_path / "a.json").write_text(json.dumps(document))
    prostm("plan", "a.json", "--preset", "fast")
    field[0, 0] = -1e-3
    np.save(tmp_path / "b.npy", field)
    refuses("plan", "b.npy", *SIZE, words=["row 0, column 0 is -0.001"])


def test_json_of_python_and_of_unequal_cells(refuses, tmp_path):
    document = {"format": "prostm-field/1", "cell_mm": 5, "origin_mm": [0, 0], "rows": 1, "cols": 2, "pressure": [[1, 2]]}
    for value in (float("nan"), float("inf"), -float("inf")):
        (tmp_path / "a.json").write_text(json.dumps(dict(document, pressure=[[1, value]])))
        refuses("plan", "a.json", words=["line 1, column", "write null where there is no value"])
    (tmp_path / "a.json").write_text(json.dumps(dict(document, cell_mm=[5, 4])))
    refuses("plan", "a.json", words=["cell_mm", "cells are square", "resample"])


def test_a_16_bit_image_keeps_its_precision(prostm, tmp_path):
    weak = np.round(200 * BLOB).astype(">u2")
    write_png(tmp_path / "a.png", 16, 0, [row.tobytes() for row in weak])
    assert pressures_of(prostm, "a.png")[1] == pytest.approx(200 / 65535, rel=0.01)


@pytest.mark.parametrize("ink, options", [(255, []), (0, ["--invert"])])
def test_a_drawing_in_the_alpha_channel_alone_gets_a_warning(prostm, tmp_path, ink, options):
    alpha = np.round(255 * BLOB).astype(np.uint8)
    alpha[alpha < 10] = 0
    write_png(tmp_path / "a.png", 8, 4, [np.stack([np.full(11, ink, np.uint8), row], -1).tobytes() for row in alpha])
    assert "its shape lies only in its transparency" in prostm("plan", "a.png", *SIZE, *options).stdout


@pytest.mark.long
def test_fields_and_plans_from_standard_input(program, prostm, refuses, tmp_path):
    def piped(data, *arguments):
        return subprocess.run([str(program), *arguments], cwd=tmp_path, input=data, capture_output=True, timeout=300)

    np.save(tmp_path / "a.npy", BLOB)
    np.savez(tmp_path / "a.npz", BLOB)
    write_png(tmp_path / "a.png", 8, 0, [row.tobytes() for row in np.round(255 * BLOB).astype(np.uint8)])
    plans = []
    for name in ("a.npy", "a.npz"):
        result = piped((tmp_path / name).read_bytes(), "plan", "-", *SIZE, "--json", "-")
        assert result.returncode == 0, result.stderr
        plans.append(json.loads(result.stdout)["paths"])
    assert plans[0] == plans[1] != []
    assert piped((tmp_path / "a.png").read_bytes(), "plan", "-", *SIZE).returncode == 0
    plan = piped((tmp_path / "a.npy").read_bytes(), "plan", "-", *SIZE, "--json", "-").stdout
    assert piped(plan, "field", "-", "--json", "f.json").returncode == 0
    for data, words in ((b"", "is empty"), (b"hello", "contains no field"), (b"\x89HDF\r\n\x1a\n", "contains an HDF5 file")):
        result = piped(data, "plan", "-", *SIZE)
        assert result.returncode == 2 and words in result.stderr.decode() and result.stderr.count(b"\n") == 1
    refuses("field", "-", "--field", "-", words=["cannot both read standard input"])
    refuses("bench", "-", words=["name its file"])


@pytest.mark.parametrize("letter", ["a", "é", "日"])
def test_output_names_may_be_as_long_as_the_file_system_allows(prostm, tmp_path, letter):
    np.save(tmp_path / "a.npy", BLOB)

    def longest(ending):
        stem = (255 - len(ending)) // len(letter.encode()) * letter
        return stem + "b" * (255 - len((stem + ending).encode())) + ending

    prostm("plan", "a.npy", *SIZE, "--json", longest(".json"), "--figure", longest(".svg"))
    prostm("run", "--grid", "32", "--stepped", "--seconds", "0.1", "--record", longest(".h5"))
    assert {path.name for path in tmp_path.iterdir()} == {"a.npy", longest(".json"), longest(".svg"), longest(".h5")}


def test_options_after_the_end_of_options(refuses, tmp_path):
    np.save(tmp_path / "-x y.npy", BLOB)
    refuses("plan", "--", "-x y.npy", "--cell-mm", "5", words=["--cell-mm follows --", "put options before it"])


@pytest.mark.parametrize("ending, words", [("vti", "z, y, x"), ("VDB", "a[:, :, k].T"), ("mat", "loadmat"),
                                           ("tiff", "[::-1]"), ("jpg", ".png"), ("csv", "loadtxt"), ("nc", "xarray")])
def test_unsupported_files_get_a_one_line_conversion(refuses, tmp_path, ending, words):
    (tmp_path / f"a.{ending}").write_bytes(b"x")
    refuses("plan", f"a.{ending}", *SIZE, words=["of an unknown kind", words])
