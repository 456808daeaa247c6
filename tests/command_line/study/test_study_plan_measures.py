"""prostm study analyse --plan with thresholds and adjusted levels: the planned test against a t test by hand."""

import json
import math
import random
import statistics
import zlib

import pytest

from conftest import ROOT

OTHER = """
[method.one-path.plan]
preset = "paper"
paths = 1

[method.one-path.emit]
full_scale_pressure = {pressure}
"""


def protocol(name, pressure, groups="within"):
    """Returns a protocol of data/protocols with a second method, so that there is something to compare."""
    text = (ROOT / "data/protocols" / name).read_text()
    assert 'methods = "within"' in text
    return text.replace('methods = "within"', f'methods = "{groups}"') + OTHER.format(pressure=pressure)


def write_lines(path, lines):
    """Writes a participant's file: every line ends with the CRC-32 of the file up to there."""
    text = ""
    for line in lines:
        body = json.dumps(line, separators=(",", ":"), ensure_ascii=False)[:-1]
        text += f'{body},"check":"{zlib.crc32((text + body).encode()):08x}"}}\n'
    path.write_text(text)


def write_answers(folder, plan, of_people):
    """Writes a file for each participant, with the plan's protocol. `of_people` has a list of trials for each."""
    lines = [json.loads(line) for line in (folder / plan).read_text().splitlines()]
    presented = next(line["protocol"] for line in lines if line.get("kind") == "protocol")
    files = []
    for person, trials in enumerate(of_people, 1):
        begin = {"kind": "begin", "format": "prostm-responses/1", "participant": str(person), "protocol": presented,
                 "trials": len(trials), "run": {"prostm": "1", "rehearsal": False}, "utc": "2099-01-01T00:00:00.000Z"}
        files.append(f"answers/participant-{person}.jsonl")
        (folder / "answers").mkdir(exist_ok=True)
        write_lines(folder / files[-1], [begin, *({"kind": "trial", "trial": i, "scene": "one-plume", **trial}
                                                  for i, trial in enumerate(trials, 1)), {"kind": "end"}])
    return files


def tail(t, df):
    """Returns the two-sided p of Student's t by Simpson's rule over u, with t = tan(u)."""
    constant = math.exp(math.lgamma((df + 1) / 2) - math.lgamma(df / 2)) / math.sqrt(df * math.pi)

    def density(u):
        return constant * (1 + math.tan(u)**2 / df) ** (-(df + 1) / 2) / math.cos(u)**2

    steps, end = 2000, math.atan(abs(t))
    width = end / steps
    inner = sum((2 if i % 2 == 0 else 4) * density(i * width) for i in range(1, steps))
    return 1 - 2 * (density(0) + inner + density(end)) * width / 3


def paired_t(first, second):
    change = [b - a for a, b in zip(first, second)]
    t = statistics.fmean(change) / (statistics.stdev(change) / math.sqrt(len(change)))
    return t, len(change) - 1


def welch_t(first, second):
    a, b = (statistics.variance(x) / len(x) for x in (first, second))
    t = (statistics.fmean(second) - statistics.fmean(first)) / math.sqrt(a + b)
    return t, (a + b)**2 / (a**2 / (len(first) - 1) + b**2 / (len(second) - 1))


def expect_test(result, first, second, test):
    t, df = test(first, second)
    assert (result["first"], result["second"]) == ("pro-stm", "one-path")
    assert result["participants"] == [len(first), len(second)]
    assert result["means"] == pytest.approx([statistics.fmean(first), statistics.fmean(second)], rel=1e-9)
    assert result["difference"] == pytest.approx(statistics.fmean(second) - statistics.fmean(first), rel=1e-9)
    assert result["statistic"] == pytest.approx(t, rel=1e-9) and result["df"] == pytest.approx(df, rel=1e-9)
    assert result["p"] == pytest.approx(tail(t, df), rel=1e-6)
    assert result["corrected_p"] == result["p"]  # one comparison
    assert result["significant"] == (result["p"] < 0.05)


def planned(prostm, folder, files):
    prostm("study", "analyse", *files, "--plan", "plan.jsonl", "--json", "a.json")
    return json.loads((folder / "a.json").read_text())


# p of Student's t in tables: 2.228 with 10, 2.776 with 4 degrees of freedom
def test_p_by_hand_is_that_of_tables():
    assert tail(2.228, 10) == pytest.approx(0.05, abs=3e-5) and tail(2.776, 4) == pytest.approx(0.05, abs=3e-5)


# A forced choice of two intervals: 75 % correct at about 1.3 with the first method and at 1.6 with the second.
def test_planned_thresholds_are_those_of_participants(prostm, tmp_path):
    (tmp_path / "a.toml").write_text(protocol("just-stronger.toml", 0.31))
    said = prostm("study", "preregister", "a.toml", "-o", "plan.jsonl").stdout
    assert said.startswith("1 planned comparisons of threshold over 8 participants")
    draw = random.Random(5)
    people = []
    for _ in range(8):
        own, trials = draw.gauss(0, 0.05), []
        for method, threshold in (("pro-stm", 1.3), ("one-path", 1.6)):
            for level in (1.0, 1.15, 1.3, 1.45, 1.6, 1.75, 1.9, 2.1, 2.4, 2.8) * 24:
                right = draw.random() < 0.5 + 0.48 / (1 + math.exp(-(level - threshold - own) / 0.15))
                interval = draw.choice((1, 2))
                trials.append({"method": method, "level": level, "reference": 1.0, "track": 1, "interval": interval,
                               "answer": interval if right else 3 - interval, "felt": int(right),
                               "correct": int(right)})
        people.append(trials)
    found = planned(prostm, tmp_path, write_answers(tmp_path, "plan.jsonl", people))
    confirmed = found["confirmatory"]
    assert confirmed["measure"] == "threshold" and confirmed["participants"] == 8 and not confirmed["left_out"]
    values = {method: {of["participant"]: of["fit"]["threshold"] for of in found["thresholds"]
                       if of["method"] == method and of["participant"]} for method in ("pro-stm", "one-path")}
    first, second = ([values[method][person] for person in sorted(values[method])] for method in values)
    assert len(first) == len(second) == 8
    assert statistics.fmean(first) == pytest.approx(1.3, abs=0.1)
    assert statistics.fmean(second) == pytest.approx(1.6, abs=0.1)
    expect_test(confirmed["results"][0], first, second, paired_t)
    assert confirmed["results"][0]["significant"]


@pytest.mark.parametrize("groups", ["within", "between"])
def test_planned_levels_are_means_of_adjustments(prostm, tmp_path, groups):
    (tmp_path / "a.toml").write_text(protocol("gain-as-strong-as-am.toml", 0.33, groups))
    said = prostm("study", "preregister", "a.toml", "-o", "plan.jsonl").stdout
    assert said.startswith("1 planned comparisons of level over 8 participants")
    draw = random.Random(7)
    people, means = [], {"pro-stm": [], "one-path": []}
    for person in range(8):
        trials = []
        for place, (method, level) in enumerate((("pro-stm", 1.4), ("one-path", 1.5))):
            if groups == "between" and person % 2 != place:
                continue
            tuned = [round(draw.gauss(level, 0.15), 4) for _ in range(6)]
            trials += [{"method": method, "level": x, "reference": "am", "start": 1.0, "changes": []} for x in tuned]
            means[method].append(statistics.fmean(tuned))
        people.append(trials)
    found = planned(prostm, tmp_path, write_answers(tmp_path, "plan.jsonl", people))
    confirmed = found["confirmatory"]
    assert confirmed["measure"] == "level" and not confirmed["left_out"]
    for of in found["adjusted"]:
        assert [by["mean"] for by in of["participants"]] == pytest.approx(means[of["method"]], rel=1e-12)
    expect_test(confirmed["results"][0], means["pro-stm"], means["one-path"],
                paired_t if groups == "within" else welch_t)


def test_a_threshold_or_level_of_one_method_has_nothing_to_compare(refuses):
    for name in ("just-stronger.toml", "continuity.toml", "gain-as-strong-as-am.toml"):
        refuses("study", "preregister", ROOT / "data/protocols" / name, "-o", "plan.jsonl",
                words=["one method", "nothing to test"])
