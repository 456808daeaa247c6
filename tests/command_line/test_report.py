"""prostm report: every number on its page is from a file, interrupted parts resume, nothing external is loaded."""

import html.parser
import json
import os
import re
import shutil
import signal
import subprocess
import time

import pytest

PAPER = {"fig4": {"trials_per_participant": 16, "AM_correct": [10, 8], "STM_correct": [14, 15], "AM_1plume": [5, 6],
                  "AM_4plume": [5, 2], "STM_1plume": [7, 8], "STM_4plume": [7, 7]}}
PARTS = ["about", "scenes", "table-1", "figure-1", "figure-2", "figure-3", "figure-4", "models", "methods", "gallery",
         "skin", "fluid", "solvers", "latency", "deviations", "machine"]


class Page(html.parser.HTMLParser):
    """The elements with data-from, the text outside them, and anything that would be loaded."""

    def __init__(self, text):
        super().__init__()
        self.shown, self.stray, self.loaded = [], [], []
        self.open, self.inside = [], 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.loaded += [(tag, name, value) for name, value in attributes.items()
                        if name in ("src", "href", "xlink:href", "srcset", "data", "action", "poster")]
        if tag in ("meta", "link", "br", "img", "input"):
            return
        self.open.append((tag, attributes))
        if "data-from" in attributes:
            self.shown.append([attributes, ""])

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if self.open and self.open[-1][0] == tag and tag not in ("meta", "link", "br", "img", "input"):
            self.open.pop()

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        tags = [tag for tag, _ in self.open]
        if "style" in tags or not data.strip():
            return
        sources = [attributes for _, attributes in self.open if "data-from" in attributes]
        if not sources:
            self.stray.append(data)
        elif "data-from" in self.open[-1][1]:
            next(one for one in reversed(self.shown) if one[0] is sources[-1])[1] += data


def value_at(document, pointer):
    for key in pointer.split("/")[1:]:
        document = document[int(key)] if isinstance(document, list) else document[key.replace("~1", "/")]
    return document


def without_times(document):
    return {key: value for key, value in document.items() if key != "timing"}


def picture_of(report, name):
    """A picture without the numbers in its identifiers, which count the pictures of a run."""
    text = (report / "parts" / f"{name}.svg").read_text()
    return re.sub(r'((?: id="|"#|url\(#)[a-z]+)[-\d]+', r"\1", text)


@pytest.fixture(scope="module")
def paper(tmp_path_factory):
    """A folder with scores like the paper's, and no other figure."""
    folder = tmp_path_factory.mktemp("paper")
    (folder / "fig4.json").write_text(json.dumps(PAPER))
    return folder


@pytest.fixture(scope="module")
def report(program, paper, tmp_path_factory):
    """The only complete quick report of these tests, with a missing browser."""
    out = tmp_path_factory.mktemp("made") / "report"
    arguments = [program, "report", "--quick", "--paper-data", paper, "--out", out]
    result = subprocess.run(arguments, capture_output=True, text=True, timeout=600, env={"PATH": "/nowhere"})
    assert result.returncode == 0, result.stderr
    assert "no report.pdf" in result.stdout
    return out


@pytest.fixture(scope="module")
def documents(report):
    return {name: json.loads((report / "parts" / f"{name}.json").read_text()) for name in PARTS}


@pytest.mark.long
def test_every_number_of_the_page_is_in_a_file(report, documents):
    page = Page((report / "index.html").read_text())
    documents = documents | {"findings": json.loads((report / "parts" / "findings.json").read_text())}
    numbers = 0
    for attributes, text in page.shown:
        file, pointer = attributes["data-from"].split("#")
        value = value_at(documents[file.removesuffix(".json")], pointer)
        if "data-digits" in attributes:
            expected = f"{value:.{int(attributes['data-digits'])}f}"
            numbers += 1
            if float(expected) == 0.0:
                expected = expected.lstrip("-")
            assert text == expected, attributes
        elif isinstance(value, str) and "{/" not in value:
            assert text == value, attributes
    assert numbers > 500
    # the title and the links to the parts are not values of a file, but are in the files too
    titles = ["Findings"] + [documents[name]["title"] for name in PARTS]
    stray = [text.strip() for text in page.stray if text.strip()]
    assert stray[:len(titles) + 2] == ["prostm report, quick"] * 2 + titles
    assert set(stray[len(titles) + 2:]) == {"Method, figures and tables"}


@pytest.mark.long
def test_the_page_opens_with_ten_linked_findings(report):
    findings = json.loads((report / "parts" / "findings.json").read_text())["timing"]
    found = [block["finding"] for block in findings if "finding" in block]
    assert len(found) == 10
    assert found[0]["text"].startswith("Models of the skin do the paper's study")
    order = ["differs", "not comparable", "agrees"]
    kinds = [order.index(one["agreement"]) for one in found[1:]]
    assert kinds == sorted(kinds)
    text = (report / "index.html").read_text()
    assert all(f'<section id="{one["section"]}">' in text for one in found)
    assert text.index('id="findings"') < text.index('id="about"')
    assert re.search(r"This is a quick report.*20 instead of 500 fields of each scene", text)


@pytest.mark.long
def test_each_section_has_a_verdict(documents):
    for name, document in documents.items():
        verdicts = [block["verdict"] for block in document["blocks"] + document["timing"] if "verdict" in block]
        assert verdicts or name == "about", name
        assert all(one["agreement"] in ("agrees", "differs", "not comparable") for one in verdicts), name


@pytest.mark.long
def test_the_page_has_no_number_of_its_own(documents):
    for name, document in documents.items():
        for block in document["blocks"] + document["timing"]:
            for row in block.get("table", {"rows": []})["rows"]:
                for key in (column["key"] for column in block["table"]["columns"]):
                    assert not isinstance(row[key], str) or not re.fullmatch(r"-?[\d.]+ ?%?", row[key]), (name, row)


@pytest.mark.long
def test_nothing_is_loaded(report):
    text = (report / "index.html").read_text()
    page = Page(text)
    for tag, name, value in page.loaded:
        assert value.startswith(("#", "data:")), (tag, name, value[:80])
    assert "<script" not in text and "@import" not in text and "http" not in text
    assert all(value.startswith("#") for value in re.findall(r"url\(([^)]*)\)", text))
    identifiers = re.findall(r' id="([^"]*)"', text)
    assert len(identifiers) == len(set(identifiers))


@pytest.mark.long
def test_all_parts_are_in_one_file(report, documents):
    whole = json.loads((report / "report.json").read_text())
    assert whole["format"] == "prostm-report/1"
    assert list(whole["parts"]) == ["findings"] + PARTS
    assert {name: whole["parts"][name] for name in PARTS} == documents


@pytest.mark.long
def test_models_are_never_called_people(documents):
    texts = [block["text"] for block in documents["models"]["blocks"] if "text" in block]
    assert any(text.startswith("These are models, not people.") for text in texts)
    rows = [block["table"]["rows"] for block in documents["models"]["blocks"] if "table" in block][0]
    assert {row["observer"] for row in rows} == {"model: skin", "model: field", "model: strength", "model: guess", "people"}


@pytest.mark.long
def test_missing_data_is_one_sentence(report, documents):
    text = (report / "index.html").read_text()
    assert text.count("The paper&apos;s own data are not included, so this page lacks half of its Fig. 2") == 1
    assert any("figure" in block for block in documents["figure-4"]["blocks"])


@pytest.mark.long
def test_existing_parts_are_kept_and_the_others_are_reproduced(program, paper, report, documents, tmp_path):
    out = tmp_path / "again"
    shutil.copytree(report, out)
    again = [name for name in PARTS if name not in ("skin", "latency", "machine")]
    for name in again:
        (out / "parts" / f"{name}.json").unlink()
    before = (out / "parts" / "skin.json").stat().st_mtime_ns
    arguments = [program, "report", "--quick", "--paper-data", paper, "--out", out]
    result = subprocess.run(arguments, capture_output=True, text=True, timeout=600, env={"PATH": "/nowhere"})
    assert result.returncode == 0, result.stderr
    assert f"{len(PARTS) - len(again)} parts were kept from an earlier run" in result.stdout
    assert (out / "parts" / "skin.json").stat().st_mtime_ns == before
    for name in again:
        made = json.loads((out / "parts" / f"{name}.json").read_text())
        assert without_times(made) == without_times(documents[name]), name
    for name in ("figure-1", "figure-2", "figure-3", "figure-4", "gallery"):
        assert picture_of(out, name) == picture_of(report, name)


@pytest.mark.long
@pytest.mark.parametrize("how, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -9)])
def test_an_interrupted_report_resumes(program, paper, report, tmp_path, how, status):
    out = tmp_path / "cut"
    shutil.copytree(report, out)
    for name in ("table-1", "skin"):
        (out / "parts" / f"{name}.json").unlink()
    arguments = [program, "report", "--quick", "--paper-data", paper, "--out", out]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True, env={"PATH": "/nowhere"}) as run:
        assert run.stdout.readline().startswith("table-1")
        time.sleep(0.2)
        run.send_signal(how)
        rest = run.communicate(timeout=60)[0]
    assert run.returncode == status
    if how != signal.SIGKILL:
        assert "run the same command again to resume" in rest
    for file in (out / "parts").glob("*.json"):
        json.loads(file.read_text())
    assert (out / "parts" / "table-1.json").is_file()
    assert not (out / "parts" / "skin.json").is_file()


def test_only_a_report_is_overwritten(refuses, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "index.html").write_text("mine")
    refuses("report", "--quick", "--out", "mine", words=["--out mine has other files than a report's"])
    refuses("report", "--quick", "--out", "mine/index.html", words=["is a file; name a folder"])
    assert (tmp_path / "mine" / "index.html").read_text() == "mine"


def test_broken_scores_are_reported_in_a_sentence(refuses, tmp_path):
    (tmp_path / "scores").mkdir()
    (tmp_path / "scores" / "fig4.json").write_text('{"fig4": {')
    refuses("report", "--quick", "--out", "r", "--paper-data", "scores", words=["fig4.json"])


@pytest.mark.long
def test_a_browser_prints_the_page(program, paper, report, tmp_path):
    """A stand-in for Chromium that writes its arguments in place of the print."""
    out, tools = tmp_path / "printed", tmp_path / "tools"
    shutil.copytree(report, out)
    tools.mkdir()
    stand_in = tools / "chromium"
    stand_in.write_text('#!/bin/sh\nfor a in "$@"; do case "$a" in --print-to-pdf=*) f="${a#*=}";; esac; done\n'
                        'echo "$@" > "$f"\n')
    stand_in.chmod(0o755)
    arguments = [program, "report", "--quick", "--paper-data", paper, "--out", out]
    result = subprocess.run(arguments, capture_output=True, text=True, timeout=60,
                            env={"PATH": f"{tools}:{os.environ['PATH']}"})
    assert result.returncode == 0 and "report.pdf" in result.stdout, result.stderr
    assert f"file://{out}/index.html" in (out / "report.pdf").read_text()
    assert sorted(file.name for file in out.iterdir()) == ["index.html", "parts", "report.json", "report.pdf"]
