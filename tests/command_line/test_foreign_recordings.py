"""Recordings as written by h5py, MATLAB and Julia: texts of fixed length, compression, and extracted frames."""

import subprocess

import h5py
import numpy as np
import pytest


@pytest.fixture(scope="module")
def recording(program, tmp_path_factory):
    """Returns a recording of prostm run."""
    folder = tmp_path_factory.mktemp("recording")
    subprocess.run([str(program), "run", "--scene", "four-plumes", "--grid", "32", "--stepped", "--seconds", "2",
                    "--record", "r.h5"], cwd=folder, check=True, capture_output=True)
    return folder / "r.h5"


def copy(source, target, text=lambda value: value, **how):
    """Copies a recording. text: maps the text of an attribute to its new value."""
    with h5py.File(source) as old, h5py.File(target, "w") as new:
        for name, value in old.attrs.items():
            made = text(value)
            if isinstance(made, tuple):  # a type, and its bytes
                made, data = made
                space = h5py.h5s.create(h5py.h5s.SCALAR)
                h5py.h5a.create(new.id, name.encode(), made, space).write(data, mtype=made)
            else:
                new.attrs[name] = made

        def visit(name, item):
            if isinstance(item, h5py.Dataset):
                new.create_dataset(name, data=item[()], maxshape=(None, *item.shape[1:]), **how)
        old.visititems(visit)


def fixed(padding, charset):
    def text(value):
        data = value.encode()
        kind = h5py.h5t.C_S1.copy()
        room = 3 if padding == h5py.h5t.STR_SPACEPAD else 0  # MATLAB leaves no room for a NUL
        kind.set_size(len(data) + room)
        kind.set_strpad(padding)
        kind.set_cset(charset)
        return kind, np.array(data.ljust(len(data) + room), f"S{len(data) + room}")
    return text


TEXTS = {"bytes": np.bytes_, "one in an array": lambda v: np.array([v], h5py.string_dtype()),
         "fixed in an array": lambda v: np.array([v.encode()]),
         "ascii": lambda v: np.array(v, h5py.string_dtype("ascii")) if v.isascii() else v,
         "null-terminated": fixed(h5py.h5t.STR_NULLTERM, h5py.h5t.CSET_UTF8),
         "null-padded": fixed(h5py.h5t.STR_NULLPAD, h5py.h5t.CSET_ASCII),
         "space-padded": fixed(h5py.h5t.STR_SPACEPAD, h5py.h5t.CSET_ASCII)}


def line_of(prostm, path, frame):
    """Returns plan's line about a frame, without the file's name."""
    said = prostm("plan", path, "--preset", "fast", "--frame", str(frame)).stdout.splitlines()[0]
    return said.split(f", frame {frame}: ")[1]


@pytest.mark.parametrize("kind", TEXTS)
def test_texts(prostm, recording, tmp_path, kind):
    copy(recording, tmp_path / "a.h5", TEXTS[kind])
    assert line_of(prostm, "a.h5", 30) == line_of(prostm, recording, 30)


@pytest.mark.parametrize("how", [{"compression": "lzf"}, {"compression": "lzf", "shuffle": True},
                                 {"compression": "gzip", "fletcher32": True}, {}])
def test_compressions(prostm, recording, tmp_path, how):
    copy(recording, tmp_path / "a.h5", **how)
    assert line_of(prostm, "a.h5", 30) == line_of(prostm, recording, 30)


def test_a_missing_compression_filter_is_named(refuses, recording, tmp_path):
    copy(recording, tmp_path / "a.h5")
    with h5py.File(recording) as old, h5py.File(tmp_path / "a.h5", "a") as new:
        create = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        create.set_chunk((8,))
        create.set_filter(32015, h5py.h5z.FLAG_OPTIONAL, ())
        del new["frame/time"]
        data = old["frame/time"][()]
        dataset = h5py.h5d.create(new["frame"].id, b"time", h5py.h5t.NATIVE_DOUBLE, h5py.h5s.create_simple(data.shape), create)
        for at in range(0, len(data), 8):  # pretends to be compressed
            dataset.write_direct_chunk((at,), data[at:at + 8].tobytes().ljust(64, b"\0"))
    refuses("plan", "a.h5", words=["/frame/time is compressed with Zstandard", "gzip"])


def cut(path, tables, rows):
    with h5py.File(path, "a") as file:
        for table in tables:
            for name, dataset in list(file[table].items()):
                data = dataset[()][rows]
                del file[table][name]
                file[table][name] = data


FRAMES = ["frame", "hand", "plan", "gate"]


@pytest.mark.parametrize("rows, frame, original", [(slice(20, 40), 5, 25), (slice(0, None, 3), 10, 30), ([3, 30], 1, 30)])
def test_extracted_frames_keep_their_patches(prostm, recording, tmp_path, rows, frame, original):
    copy(recording, tmp_path / "a.h5")
    cut(tmp_path / "a.h5", FRAMES, rows)
    assert line_of(prostm, "a.h5", frame) == line_of(prostm, recording, original)


def test_frames_without_their_own_patches_are_rejected(refuses, recording, tmp_path):
    def patches(file):
        return [name for name, item in file["target"].items() if item.shape[0] == file["target/frame"].shape[0]]

    def take(path, names, rows):
        with h5py.File(path, "a") as file:
            for name in names:
                data = file["target"][name][()][rows]
                del file["target"][name]
                file["target"][name] = data

    with h5py.File(recording) as file:
        names = patches(file)
    for rows in (slice(10, 40), slice(0, None, 2), slice(5, None)):
        copy(recording, tmp_path / "a.h5")
        cut(tmp_path / "a.h5", FRAMES, slice(0, 12))
        take(tmp_path / "a.h5", names, rows)
        refuses("plan", "a.h5", "--frame", "11", words=["its tables are inconsistent", "docs/guides/recordings.md"])
    copy(recording, tmp_path / "a.h5")
    cut(tmp_path / "a.h5", ["frame"], slice(10, 30))  # but their plans are kept
    refuses("plan", "a.h5", words=["its tables are inconsistent"])
