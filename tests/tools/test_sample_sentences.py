"""tools/sample_sentences.py: what counts as a sentence of a document, a comment and a message."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import sample_sentences  # noqa: E402


def test_sentences_are_split_and_short_ones_are_left_out():
    text = "A plan has up to eight\nclosed paths. Short one. `Code` may begin a sentence of enough words."
    assert list(sample_sentences.sentences_of(text)) == [
        "A plan has up to eight closed paths.", "`Code` may begin a sentence of enough words."]


def test_a_document_has_paragraphs_and_items_without_code_and_tables():
    text = "# Title\n\nFirst paragraph.\n\n- item one\n- item two\n\n```sh\nprostm run\n```\n\n| a | b |\n|---|---|\n"
    assert [p.strip() for p in sample_sentences.paragraphs_of(text)] == ["First paragraph.", "item one", "item two"]


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    files = {"src/prostm/a.hpp": "/// Returns the length of a path\n/// between two points.\nint f();\n",
             "src/prostm/a.cpp": 'throw Error("the file has no plan "\n            "of a loop");\n',
             "README.md": "This is the only sentence here.\n", "CONTRIBUTING.md": ""}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(sample_sentences, "ROOT", tmp_path)


@pytest.mark.usefixtures("checkout")
def test_a_sample_has_each_kind_once():
    assert [(kind, str(path), text) for kind, path, text in sample_sentences.sample(seed=1, count=3)] == [
        ("document", "README.md", "This is the only sentence here."),
        ("comment", "src/prostm/a.hpp", "Returns the length of a path between two points."),
        ("message", "src/prostm/a.cpp", "the file has no plan of a loop")]
