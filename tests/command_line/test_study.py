"""prostm study analyse: figures without overlapping texts, thresholds, and tidy tables. prostm study run: rejected
input, a rehearsal, and a session that is killed."""

import csv
import json
import math
import random
import re
import resource
import signal
import socket
import subprocess
from itertools import combinations, product
from xml.etree import ElementTree

import pytest

from conftest import ROOT, SHORT, shared_file
from waiting import wait_for

MADE_UP = ROOT / "data" / "made-up-answers.csv"
SVG = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"


def boxes_of_texts(path):
    """Returns the page's box and that of each text in an SVG figure by cairo, as (left, top, right, bottom)."""
    root = ElementTree.parse(path).getroot()
    glyphs = {}
    for symbol in root.iter(SVG + "symbol"):
        numbers = [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?", symbol.find(SVG + "path").get("d"))]
        if numbers:
            glyphs["#" + symbol.get("id")] = min(numbers[::2]), min(numbers[1::2]), max(numbers[::2]), max(numbers[1::2])
    texts = []
    for group in root.iter(SVG + "g"):
        places = [(glyphs[use.get(LINK)], float(use.get("x")), float(use.get("y")))
                  for use in group.findall(SVG + "use") if use.get(LINK) in glyphs]
        if places:
            left, top, right, bottom = zip(*((x + a, y + b, x + c, y + d) for (a, b, c, d), x, y in places))
            texts.append((min(left), min(top), max(right), max(bottom)))
    return tuple(map(float, root.get("viewBox").split())), texts


def write_answers(path, methods, scenes, people, within=True, long_names=False, level=False):
    """Answers to four trials of each scene; methods differ, so that there are brackets."""
    draw = random.Random(methods * 100 + scenes * 10 + people)
    method = "amplitude modulated foci in a style that needs a very long name " if long_names else "m"
    scene = "four plumes, and hands that move through them, " if long_names else "s"
    rows = []
    for person in range(people):
        mine = range(methods) if within else [person % methods]
        for m, s, trial in product(mine, range(scenes), range(20 if level else 4)):
            x = draw.choice((0.2, 0.4, 0.6, 0.8))
            share = 0.5 + 0.48 / (1 + math.exp(-15 * (x - 0.3 - 0.1 * m))) if level else 0.3 + 0.2 * m
            rows.append([f"P{person}", f"{method}{m}", f"{scene}{s}", int(draw.random() < share)] + [x] * level)
    with open(path, "w", newline="") as file:
        csv.writer(file).writerows([["participant", "method", "scene", "correct"] + ["level"] * level] + rows)


def check_texts(path, least):
    (_, _, width, height), texts = boxes_of_texts(path)
    assert len(texts) >= least
    for left, top, right, bottom in texts:
        assert 0 <= left and 0 <= top and right <= width and bottom <= height
    for a, b in combinations(texts, 2):
        over = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
        assert min(over) < 0.1, f"{a} and {b} overlap in {path}"


@pytest.mark.parametrize("level", [False, True])
@pytest.mark.parametrize("long_names", [False, True])
@pytest.mark.parametrize("methods, scenes", [(1, 1), (2, 1), (2, 2), (3, 5), (4, 6)])
def test_texts_in_a_figure_do_not_overlap(prostm, tmp_path, methods, scenes, long_names, level):
    write_answers(tmp_path / "a.csv", methods, scenes, 6, long_names=long_names, level=level)
    prostm("study", "analyse", "a.csv", "--figure", "a.svg")
    check_texts(tmp_path / "a.svg", 10)


@pytest.mark.parametrize("people", [4, 60])
def test_a_figure_fits_few_people_and_many(prostm, tmp_path, people):
    write_answers(tmp_path / "a.csv", 2, 2, people, within=False)
    prostm("study", "analyse", "a.csv", "--figure", "a.svg")
    check_texts(tmp_path / "a.svg", 10)


def test_the_papers_scores_are_drawn(prostm, tmp_path):
    scores = shared_file("data/paper/fig4.json")
    for name in ("a.svg", "a.png", "a.pdf"):
        done = prostm("study", "analyse", scores, "--figure", name)
        assert done.stdout.endswith(f"wrote {name}\n")
    # title, two methods, axis with its name, chance, shares, scenes, two brackets of two lines each, the note
    check_texts(tmp_path / "a.svg", 1 + 2 + 6 + 1 + 1 + 6 + 3 + 2 * 2 + 3)
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_thresholds_are_fitted_if_answers_have_levels(prostm, tmp_path):
    write_answers(tmp_path / "a.csv", 2, 1, 40, level=True)
    said = prostm("study", "analyse", "a.csv", "--lapse", "0.02", "--guess", "0.5", "--json", "a.json").stdout
    analysis = json.loads((tmp_path / "a.json").read_text())
    assert (analysis["guess"], analysis["lapse"]) == (0.5, 0.02)
    found = {(of["method"], of["participant"]): of for of in analysis["thresholds"]}
    assert len(found) == 2 * 41
    rows = list(csv.DictReader(open(tmp_path / "a.csv", newline="")))
    for method, truth in (("m0", 0.3), ("m1", 0.4)):
        pooled = found[method, None]
        low, high = pooled["fit"]["threshold_interval"]
        assert low < pooled["fit"]["threshold"] < high and high - low < 0.2
        assert pooled["fit"]["threshold"] == pytest.approx(truth, abs=0.06)
        assert f"With {method} in s0, the threshold is {pooled['fit']['threshold']:.4g} (95 % interval" in " ".join(
            said.split())
        for level in pooled["levels"]:
            mine = [int(r["correct"]) for r in rows if r["method"] == method and float(r["level"]) == level["level"]]
            assert (level["correct"], level["answers"]) == (sum(mine), len(mine))
    for of in found.values():
        assert (of["fit"] is None) == ("no_fit" in of)
    assert "no fit: " in said  # for a participant, with 20 answers


def test_answers_of_which_some_lack_levels_are_rejected(prostm, refuses, tmp_path):
    header = "participant,method,scene,correct,level\n"
    (tmp_path / "a.csv").write_text(header + "1,am,x,1,0.5\n2,am,x,1,\n")
    refuses("study", "analyse", "a.csv", words=["a.csv, line 3: level is \"\"", "number"])
    refuses("study", "analyse", MADE_UP, "--lapse", "0.02", words=["no level"])
    (tmp_path / "a.csv").write_text(header + "1,am,x,1,0.5\n2,am,x,1,0.5\n")
    refuses("study", "analyse", "a.csv", "--guess", "0.95", words=["guess = 0.95", "0.9"])
    refuses("study", "analyse", "a.csv", "--lapse", "-0.1", words=["lapse = -0.1"])
    assert "all answers are at one level" in prostm("study", "analyse", "a.csv").stdout


def test_a_json_list_is_rejected_with_its_conversion(refuses, tmp_path):
    (tmp_path / "jspsych.json").write_text('\n[{"participant": "a", "method": "am", "scene": "x", "correct": true}]')
    for files in (["jspsych.json"], [MADE_UP, "jspsych.json"]):
        refuses("study", "analyse", *files, words=["jspsych.json", "list", "CSV", "to_csv"])


def test_a_tidy_table_has_the_same_answers(prostm, refuses, tmp_path):
    assert prostm("study", "analyse", MADE_UP, "--tidy", "a.csv").stdout.endswith("wrote a.csv\n")
    assert (tmp_path / "a.csv").read_bytes().count(b"\r\n") == len(MADE_UP.read_text().splitlines())
    with open(MADE_UP, newline="") as before, open(tmp_path / "a.csv", newline="") as after:
        tidy = csv.DictReader(after)
        assert tidy.fieldnames == ["participant", "method", "scene", "trial", "question", "answer", "correct", "response_s"]
        def of(row):
            return {name: float(row[name]) if name == "response_s" else row[name] for name in tidy.fieldnames}
        assert [of(row) for row in csv.DictReader(before)] == [of(row) for row in tidy]
    said = [prostm("study", "analyse", name).stdout for name in (MADE_UP, "a.csv")]
    assert said[0] == said[1]
    write_answers(tmp_path / "b.csv", 2, 1, 2, level=True)
    prostm("study", "analyse", "b.csv", "--tidy", "c.csv")
    assert (tmp_path / "b.csv").read_bytes() == (tmp_path / "c.csv").read_bytes()
    refuses("study", "analyse", MADE_UP, "--tidy", "a.txt", words=["a.txt names no table; it must end in .csv"])
    refuses("study", "analyse", "a.csv", "--tidy", "a.csv", words=["one file"])


PROTOCOL = ROOT / "data" / "protocols" / "one-plume-or-four.toml"
STUDY = ["study", "run", "short.toml", "--view-port", "0", "--participant"]


@pytest.mark.parametrize("text, words", [
    ("[study", ["p.toml, line 1", "not valid TOML"]),
    (SHORT + "[trails]\n", ["p.toml, line ", "trails", "trials"]),
    (SHORT.replace("repeats = 1", "repeats = 0"), ["p.toml, line 5: trials.repeats", "between 1 and 1000"]),
    (SHORT.replace('question = "One?"', ""), ["[scene.one-plume] has no question"]),
    (SHORT.replace("one-plume", "fog"), ["[scene.fog]", "still-air"]),
    (SHORT[:SHORT.index("[method")], ["0 [method.NAME]"]),
    (SHORT + "[method.b.pipeline]\ndevice = \"sim\"\n", ["[method.b] sets pipeline.device", "command line"]),
    (SHORT[:100], ["p.toml"]),
], ids=["syntax", "table", "bounds", "question", "scene", "methods", "device", "half"])
def test_an_invalid_protocol_is_rejected_with_its_place(refuses, tmp_path, text, words):
    (tmp_path / "p.toml").write_text(text)
    refuses("study", "run", "p.toml", "--participant", "1", words=words)
    assert not (tmp_path / "answers").exists()


def test_a_session_that_cannot_start_leaves_no_file(refuses, tmp_path):
    (tmp_path / "short.toml").write_text(SHORT)
    (tmp_path / "file").touch()
    refuses(*STUDY, "0", words=["--participant 0", "1 and 9999"])
    refuses(*STUDY, "010", "--resume", words=["participant 10 has not begun", "participant-10.jsonl"])  # and not 8, octal
    refuses(*STUDY, "09", "--resume", words=["participant 9 has not begun"])
    refuses(*STUDY, "1", "--answers", "file", words=["--answers file cannot be a folder"])
    refuses(*STUDY, "1", "--resume", words=["participant 1 has not begun", "leave --resume out"])
    refuses(*STUDY, "1", "--rehearse", "-1", words=["--rehearse -1"])
    refuses(*STUDY, "1", "--hand", "page", words=["--hand page", "the pages of a study cannot move a hand"])
    refuses(*STUDY, "1", "--hand", "nowhere.hands.jsonl", words=["nowhere.hands.jsonl"])
    refuses("study", "run", "nowhere.toml", "--participant", "1", words=["nowhere.toml"])
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        refuses(*STUDY, "1", "--view-port", port, words=["--view-port is given 2 times"])
        refuses("study", "run", "short.toml", "--participant", "1", "--view-port", port, words=[port, "in use"])
    assert not list((tmp_path / "answers").iterdir())


@pytest.mark.long
def test_a_rehearsal_runs_all_trials_and_is_distinguished_from_answers(prostm, tmp_path):
    (tmp_path / "short.toml").write_text(SHORT)
    for participant in "12":
        said = prostm(*STUDY, participant, "--rehearse", "0").stdout
        assert f"Participant {participant}: 2 of 2 answers in answers/rehearsal-{participant}.jsonl." in said
        levels = re.findall(r"^Quality of stimuli of ([a-z ]+),.*\n(?:  .*\n)+?  felt strength +about -?\d+ dB ", said, re.M)
        assert levels == ["stationary foci"]
    said = prostm("study", "analyse", "answers/rehearsal-1.jsonl", "answers/rehearsal-2.jsonl").stdout
    assert said.count("is a rehearsal: nobody felt anything") == 2
    assert "2 participants" in said


def test_a_killed_session_resumes_and_an_edited_one_does_not(program, prostm, refuses, tmp_path):
    (tmp_path / "short.toml").write_text(SHORT)
    file = tmp_path / "answers" / "participant-7.jsonl"
    process = subprocess.Popen([str(program), *STUDY, "7"], cwd=tmp_path, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for(lambda: file.exists() and file.read_text().endswith("\n"))
    refuses(*STUDY, "7", "--resume", words=["participant-7.jsonl", "another program"])
    process.send_signal(signal.SIGKILL)
    process.wait()
    refuses(*STUDY, "7", words=["participant 7 has begun", "--resume"])
    with open(file, "a") as half:
        half.write('{"kind":"trial","trial":1')
    process = subprocess.Popen([str(program), *STUDY, "7", "--resume"], cwd=tmp_path, text=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lines = [process.stdout.readline() for _ in range(4)]
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    said = "".join(lines) + rest
    assert process.returncode == 130, said
    assert "The last line of answers/participant-7.jsonl was cut off" in said
    assert (file.parent / "participant-7.jsonl.cut-off").read_text() == '{"kind":"trial","trial":1\n'
    text = file.read_text()
    file.write_text(text.replace('"seed":1,', '"seed":2,'))
    refuses(*STUDY, "7", "--resume", words=["line 1 does not match its check", "edited"])
    refuses("study", "analyse", file, words=["line 1 does not match its check"])
    file.write_text(text)
    (tmp_path / "short.toml").write_text(SHORT.replace("rest = 0.1", "rest = 0.2"))
    refuses(*STUDY, "7", "--resume", words=["begun with another protocol"])


@pytest.mark.long
def test_answers_that_do_not_fit_on_the_disk_are_not_counted(program, prostm, tmp_path):
    (tmp_path / "short.toml").write_text(SHORT.replace("repeats = 1", "repeats = 4"))
    prostm(*STUDY, "1", "--rehearse", "0")
    lines = (tmp_path / "answers" / "rehearsal-1.jsonl").read_bytes().splitlines(keepends=True)
    trials = [i for i, line in enumerate(lines) if json.loads(line)["kind"] == "trial"]
    limit = len(b"".join(lines[:trials[2]])) + len(lines[trials[2]]) // 2

    def fill():  # emulates a full disk
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    file = tmp_path / "answers" / "rehearsal-2.jsonl"
    process = subprocess.Popen([str(program), *STUDY, "2", "--rehearse", "0"], cwd=tmp_path, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=fill, restore_signals=False)
    seen = []

    def tries_again():  # a line is started and taken back: the file keeps its size, with a new time
        if not file.exists():
            return False
        now = file.stat()
        tried = any(size == now.st_size and then != now.st_mtime_ns for size, then in seen)
        seen.append((now.st_size, now.st_mtime_ns))
        return tried

    wait_for(tries_again)
    process.send_signal(signal.SIGINT)
    said, errors = process.communicate(timeout=60)
    written = sum(json.loads(line)["kind"] == "trial" for line in file.read_text().splitlines())
    assert f"Participant 2: {written} of 8 answers in answers/rehearsal-2.jsonl." in said
    assert process.returncode == 2 and "could not be written" in errors and "--resume" in errors


def test_a_number_is_decimal_however_it_is_written(prostm, refuses, tmp_path):
    (tmp_path / "short.toml").write_text(SHORT)
    said = prostm(*STUDY, "010", "--rehearse", "1").stdout
    assert "Participant 10: 1 of 2 answers in answers/rehearsal-10.jsonl." in said
    refuses(*STUDY, "10", "--rehearse", "1", words=["participant 10 has begun"])
    refuses(*STUDY, " 10", "--rehearse", "1", words=["participant 10 has begun"])
    refuses(*STUDY, "0x10", words=["--participant 0x10", "number between 1 and 9999"])
    # the same person in a file with another name
    (tmp_path / "answers" / "rehearsal-10.jsonl").rename(tmp_path / "answers" / "first.jsonl")
    refuses(*STUDY, "10", "--rehearse", "1", words=["participant 10 has begun in answers/first.jsonl", "another number"])


@pytest.mark.long
def test_a_participant_replaces_another(prostm, refuses, tmp_path):
    (tmp_path / "short.toml").write_text("[study]\nparticipants = 4\nmethods = \"within\"\n" + SHORT + "[method.b.fluid]\ncells = 32\n")
    def header(number):
        return json.loads((tmp_path / "answers" / f"rehearsal-{number}.jsonl").read_text().splitlines()[0])
    def conditions(number):
        lines = map(json.loads, (tmp_path / "answers" / f"rehearsal-{number}.jsonl").read_text().splitlines())
        return [(line["method"], line["scene"], line["question"]) for line in lines if line["kind"] == "trial"]
    rehearse = ("--rehearse", "0")
    for number in "23":
        prostm(*STUDY, number, *rehearse)
    refuses(*STUDY, "9", *rehearse, "--replaces", "4", words=["--replaces 4", "no participant", "study status"])
    prostm(*STUDY, "9", *rehearse, "--replaces", "02")
    assert (header(9)["replaces"], header(9)["order"]) == ("2", 2)
    assert conditions(9) == conditions(2)
    refuses(*STUDY, "10", *rehearse, "--replaces", "2", words=["participant 2 was replaced by 9", "--replaces 9"])
    (tmp_path / "other.toml").write_text(SHORT)
    refuses("study", "run", "other.toml", "--participant", "11", *rehearse, "--replaces", "3", words=["another protocol"])
    files = [f"answers/rehearsal-{n}.jsonl" for n in (2, 3, 9)]
    said = prostm("study", "analyse", *files).stdout
    assert "Participant 2 was replaced by 9 and is left out" in said
    assert "2 participants" in said


@pytest.mark.long
def test_status_reports_how_full_each_group_is(program, prostm, refuses, tmp_path):
    refuses("study", "status", words=["answers"])
    (tmp_path / "short.toml").write_text("[study]\ntitle = \"T\"\nparticipants = 4\n" + SHORT + "[method.b.fluid]\ncells = 32\n")
    (tmp_path / "answers").mkdir()
    refuses("study", "status", words=["no participant's file"])
    file = tmp_path / "answers" / "participant-3.jsonl"
    process = subprocess.Popen([str(program), *STUDY, "3"], cwd=tmp_path, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for(lambda: file.exists() and file.read_text().endswith("\n"))
    process.send_signal(signal.SIGINT)
    process.wait()
    prostm(*STUDY, "1", "--rehearse", "1")
    said = prostm("study", "status", "--json", "s.json").stdout
    assert "T: 4 participants planned" in said and "Rehearsals left out: 1" in said
    study, = json.loads((tmp_path / "s.json").read_text())["studies"]
    assert sorted(group["planned"] for group in study["groups"]) == [2, 2]
    assert sum(group["under_way"] for group in study["groups"]) == 1
    assert sorted(n for group in study["groups"] for n in group["open"]) == [1, 2, 4]
    only, = study["participants"]
    assert (only["participant"], only["answers"], only["state"]) == ("3", 0, "under way")
    assert prostm("study", "status", file).stdout.splitlines()[:3] == said.splitlines()[:3]


EXAMPLES = {"gain-as-strong-as-am": "adjusted", "continuity": "felt", "number-of-paths": "felt", "just-stronger": "right"}
QUICK = {"settle = 2\n": "", "seconds = 60": "seconds = 0", "interval = 1.5": "interval = 0.3", "interval = 1.0": "interval = 0.3",
         "interval = 2\n": "interval = 0.3\n", "interval = 3\n": "interval = 0.3\n", "gap = 0.7": "gap = 0.1", "gap = 0.6": "gap = 0.1",
         "[trials]\n": "[trials]\nrest = 0.1\nsettle = 0.5\ngate = \"off\"\n", "preset = \"paper\"": "preset = \"fast\""}


@pytest.mark.long
@pytest.mark.parametrize("name", EXAMPLES)
def test_each_example_with_levels_can_be_rehearsed_and_analysed(prostm, tmp_path, name):
    text = (ROOT / "data" / "protocols" / f"{name}.toml").read_text()
    for slow, quick in QUICK.items():
        text = text.replace(slow, quick)
    (tmp_path / "p.toml").write_text(text)
    (tmp_path / "s.toml").write_text("[fluid]\ncells = 32\n")
    for participant in "12":
        said = prostm("study", "run", "p.toml", "--settings", "s.toml", "--view-port", "0", "--participant", participant, "--rehearse", "3").stdout
        assert f"Participant {participant}: 3 " in said
    files = [f"answers/rehearsal-{n}.jsonl" for n in "12"]
    trials = [line for file in files for line in map(json.loads, open(tmp_path / file)) if line["kind"] == "trial"]
    assert len(trials) == 6 and all("level" in line for line in trials)
    first, *_ = map(json.loads, open(tmp_path / files[0]))
    low, high = (first["protocol"]["level"][key] for key in ("low", "high"))
    assert all(low <= line["level"] <= high for line in trials)
    said = prostm("study", "analyse", *files, "--json", "a.json", "--tidy", "t.csv").stdout
    assert said.count("is a rehearsal: nobody felt anything") == 2
    analysis = json.loads((tmp_path / "a.json").read_text())
    kind = EXAMPLES[name]
    assert analysis["kind"] == kind
    rows = list(csv.DictReader(open(tmp_path / "t.csv", newline="")))
    assert [float(row["level"]) for row in rows] == [line["level"] for line in trials]
    assert all(row.get("kind", "right") == kind for row in rows)
    if kind == "adjusted":
        of, = analysis["adjusted"]
        means = [sum(line["level"] for line in trials[i:i + 3]) / 3 for i in (0, 3)]
        assert [p["mean"] for p in of["participants"]] == pytest.approx(means)
        assert of["mean"] == pytest.approx(sum(means) / 2)
        half = 12.7062 * abs(means[0] - means[1]) / 2  # t with one degree of freedom, sd / sqrt(2)
        assert of["interval"] == pytest.approx([of["mean"] - half, of["mean"] + half], rel=1e-3)
        assert f"it felt alike at {of['mean']:.4g}, the mean of 2 participants" in " ".join(said.split())
        assert all(line["changes"][-1][1] == line["level"] for line in trials if line["changes"])
    else:
        assert analysis["guess"] == (0.5 if kind == "right" else 0)
        assert ("answers were right" in " ".join(said.split())) == (kind == "right")
    prostm("study", "analyse", "t.csv", "--json", "b.json")
    table = json.loads((tmp_path / "b.json").read_text())
    del table["notes"], analysis["notes"]  # about participants' files, which the table is not
    assert table == analysis, "the table says the same"


def write_rows(path, header, rows, encoding="utf-8", delimiter=","):
    with open(path, "w", newline="", encoding=encoding) as file:
        csv.writer(file, delimiter=delimiter).writerows([header.split(",")] + rows)


def test_one_participants_answers_are_analysed(prostm, tmp_path):
    rows = [["1", method, "x", int(k < right), level] for method in ("am", "stm")
            for level, right in ((0.2, 11), (0.4, 13), (0.6, 17), (0.8, 20)) for k in range(20)]
    write_rows(tmp_path / "a.csv", "participant,method,scene,correct,level", rows)
    said = " ".join(prostm("study", "analyse", "a.csv", "--json", "a.json", "--figure", "a.svg").stdout.split())
    assert said.startswith("1 participant, 2 methods")
    assert "All answers are of one participant, so results about people in general" in said
    assert "Over participants" not in said
    analysis = json.loads((tmp_path / "a.json").read_text())
    comparison, = analysis["scenes"][0]["comparisons"]
    assert comparison["permutation_p"] is None and comparison["t"] is None and comparison["fisher_p"] == 1
    assert analysis["thresholds"][0]["fit"]["threshold"] == pytest.approx(0.55, abs=0.1)
    assert analysis["thresholds"][0]["fit"]["misfit"]["df"] == 2


def test_a_threshold_beyond_the_levels_is_censored(prostm, tmp_path):
    header = "participant,method,scene,correct,kind,level"
    for name, is_yes in (("yes", lambda x: 1), ("no", lambda x: 0), ("step", lambda x: int(x > 1.3)), ("fall", lambda x: int(x < 1.3))):
        rows = [[who, "am", "x", is_yes(x), "felt", x] for who in "12" for x in (1.0, 1.2, 1.4, 1.6) for _ in range(10)]
        write_rows(tmp_path / f"{name}.csv", header, rows)
    results = {}
    for name in ("yes", "no", "step", "fall"):
        said = " ".join(prostm("study", "analyse", f"{name}.csv", "--json", "a.json", "--figure", "a.svg").stdout.split())
        assert "right answers" not in said
        results[name] = json.loads((tmp_path / "a.json").read_text())["thresholds"][0], said
    assert results["yes"][0]["bounds"]["threshold"] == [None, 1.0]
    assert "it is below 1 (95 % interval" in results["yes"][1]
    assert results["no"][0]["bounds"]["threshold"] == [1.6, None]
    assert results["step"][0]["bounds"]["threshold"] == [1.2, 1.4]
    assert "best from 1.2 to 1.4" in results["step"][1]
    assert "bounds" not in results["fall"][0] and "fall with the level" in results["fall"][1]
    assert "step" not in results["fall"][1]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
def test_tables_of_other_programs_give_the_same_results(prostm, tmp_path, encoding, delimiter):
    people = ["Jürgen", "Zoë", "3"]
    trials = [(who, method, k) for who in people for method in ("am", "stm") for k in range(6)]
    rows = [[who, method, "x", (0, 1)[k < 3 + len(who) % 3], k / 4] for who, method, k in trials]
    write_rows(tmp_path / "plain.csv", "participant,method,scene,correct,level", rows)
    others = [[str(y).replace(".", ","), method, ("False", "True")[c], who, x] for who, method, x, c, y in rows]
    others.insert(1, ["", "", "", "3", ""])  # an instruction
    others.insert(2, ["0,5", "am", "", "3", "x"])  # no answer
    write_rows(tmp_path / "other.csv", "Intensity,Condition,key_resp.corr,Subject ID,Image", others, encoding, delimiter)
    names = "participant=subject id,method=condition,scene=image,correct=key_resp.corr,level=intensity"
    said = prostm("study", "analyse", "other.csv", "--columns", names, "--json", "b.json", "--tidy", "tidy.csv").stdout
    assert "1 of 38 rows have no method and scene" in said
    prostm("study", "analyse", "plain.csv", "--json", "a.json")
    a, b = (json.loads((tmp_path / f"{name}.json").read_text()) for name in "ab")
    assert b["missing"] == [{"scene": "x", "method": "am", "missing": 1, "trials": 19, "participants": 1,
                             "if_answered": [a["scenes"][0]["methods"][0]["correct"] / 19,
                                             (a["scenes"][0]["methods"][0]["correct"] + 1) / 19]},
                            {"scene": "x", "method": "stm", "missing": 0, "trials": 18, "participants": 0,
                             "if_answered": [a["scenes"][0]["methods"][1]["correct"] / 18] * 2}]
    for key in ("participants", "scenes", "thresholds"):
        assert sorted(map(str, a[key])) == sorted(map(str, b[key])) if key == "participants" else a[key] == b[key]
    tidy = (tmp_path / "tidy.csv").read_bytes().decode("utf-8")
    assert "Jürgen" in tidy and tidy.count("\r\n") == 38


def test_names_that_differ_only_in_spelling_do_not_duplicate_people(prostm, refuses, tmp_path):
    rows = [[f"0{who}" if method == "am" else who, method, "x", (who + k) % 2] for who in range(1, 5) for method in ("am", "stm") for k in range(4)]
    write_rows(tmp_path / "a.csv", "participant,method,scene,correct", rows)
    refuses("study", "analyse", "a.csv", words=['participants "01" and "1"', "and others", "--merge-spellings"])
    said = prostm("study", "analyse", "a.csv", "--merge-spellings").stdout
    assert said.startswith("4 participants, each with all methods") and "each pair is treated as one" in said
    rows = [[f"{row[0]} " if row[1] == "stm" else f"\u00a0{row[0]}"] + row[1:] for row in rows]
    rows = [[row[0].replace("0", "")] + row[1:] for row in rows]
    write_rows(tmp_path / "a.csv", "participant,method,scene,correct", rows)
    assert prostm("study", "analyse", "a.csv").stdout.startswith("4 participants, each with all methods")


def test_tables_of_adjustments_and_of_mixed_kinds(prostm, refuses, tmp_path):
    header = "participant,method,scene,correct,level,kind\n"
    (tmp_path / "a.csv").write_text(header + "1,stm,x,0,1.2,adjusted\n1,stm,x,0,1.6,adjusted\n2,stm,x,0,1.8,adjusted\n")
    said = prostm("study", "analyse", "a.csv").stdout
    assert re.search(r"x +stm +all +3 +1\.6 +0\.2828", said), said
    refuses("study", "analyse", "a.csv", "--figure", "a.svg", words=["--figure", "these are adjustments"])
    refuses("study", "analyse", "a.csv", "--guess", "0.1", words=["--guess", "these are adjustments"])
    (tmp_path / "a.csv").write_text(header + "1,stm,x,0,1.2,adjusted\n1,stm,x,0,1.6,felt\n")
    refuses("study", "analyse", "a.csv", words=["line 3: kind is \"felt\", but earlier rows"])
    (tmp_path / "a.csv").write_text(header + "1,stm,x,0,1.2,tuned\n")
    refuses("study", "analyse", "a.csv", words=["line 2: kind", "right, felt or adjusted"])
    (tmp_path / "a.csv").write_text("participant,method,scene,correct,kind\n1,stm,x,0,felt\n")
    refuses("study", "analyse", "a.csv", words=["no column \"level\""])


def test_a_protocol_whose_levels_have_no_effect_is_rejected(refuses, tmp_path):
    text = (ROOT / "data" / "protocols" / "just-stronger.toml").read_text()
    (tmp_path / "p.toml").write_text(text.replace("full_scale_pressure = 0.31", "fade_time = 0.001"))
    refuses("study", "run", "p.toml", "--participant", "1", words=["plan.gain", "would change nothing", "full_scale_pressure"])
    (tmp_path / "p.toml").write_text(text.replace("high = 2.8", "high = 280"))
    refuses("study", "run", "p.toml", "--participant", "1", words=["line 23: level.high = 280 cannot be played with method pro-stm", "gain = 280"])
