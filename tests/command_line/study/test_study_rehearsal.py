"""Tests of rehearsals with a simulated clock, and of practice, catch and attention trials on the command line."""

import json

from conftest import SHORT

CHECKS = SHORT.replace("[trials]\nrepeats = 1", """[practice]
trials = 3
right = 0
[trials]
repeats = 2
catch_every = 2
attention_every = 4
time_limit = 0.5
fixed_duration = true""")


def rehearse(prostm, participant, *options):
    return prostm("study", "run", "study.toml", "--participant", participant, "--rehearse", "0", "--as-fast-as-possible",
                  *options).stdout


def lines_of(tmp_path, participant):
    text = (tmp_path / "answers" / f"rehearsal-{participant}.jsonl").read_text()
    return [json.loads(line) for line in text.splitlines()]


def test_a_simulated_clock_leads_four_participants_to_an_analysis(prostm, tmp_path):
    (tmp_path / "study.toml").write_text(SHORT)
    for participant in range(1, 5):
        said = rehearse(prostm, participant)
        assert "with a simulated clock." in said
        assert f"Participant {participant}: 2 of 2 answers" in said
        assert "felt strength" in said
        file = lines_of(tmp_path, participant)
        assert file[0]["run"]["rehearsal"] is True and file[0]["run"]["clock"] == "simulated"
        trials = [line for line in file if line["kind"] == "trial"]
        assert len(trials) == 2
        times = [line["time_s"] for line in file]
        assert times == sorted(times)
        for trial in trials:
            assert trial["rendered_mn"] > 0 and trial["target_mn"] > 0
            assert trial["played"]["period_ms"] == 5.0  # AM at 200 Hz
            # the answer comes half a second after the stimulus began, by the simulated clock
            assert 0.5 <= trial["response_s"] <= 0.56
            assert trial["page"] == {"open": True, "missing_s": {}, "interrupted": 0}
    said = prostm("study", "analyse", *(f"answers/rehearsal-{n}.jsonl" for n in range(1, 5))).stdout
    assert "4 participants" in said


def test_practice_and_checks_are_rehearsed_and_are_no_answers(prostm, tmp_path):
    (tmp_path / "study.toml").write_text(CHECKS)
    said = prostm("study", "check", "study.toml").stdout
    for words in ("practice: 3 trials before the trials of each method\n", "one catch trial, without a stimulus, in every 2 trials",
                  "one attention trial, in every 4 trials", "answers are taken after the stimulus"):
        assert words in said
    said = rehearse(prostm, 1)
    assert "Participant 1: 4 of 4 answers" in said
    kinds = [line["kind"] for line in lines_of(tmp_path, 1)]
    counts = {kind: kinds.count(kind) for kind in ("practice", "practised", "catch", "attention", "trial")}
    assert counts == {"practice": 3, "practised": 1, "catch": 2, "attention": 1, "trial": 4}
    assert kinds.index("practised") < kinds.index("trial")
    trials = [line for line in lines_of(tmp_path, 1) if line["kind"] == "trial"]
    assert all(0.5 <= trial["response_s"] <= 1.1 for trial in trials)


def test_a_simulated_clock_is_refused_where_time_is_real(refuses, tmp_path):
    (tmp_path / "study.toml").write_text(SHORT)
    study = ["study", "run", "study.toml", "--participant", "1", "--as-fast-as-possible"]
    refuses(*study, words=["--as-fast-as-possible", "add --rehearse 0"])
    refuses(*study, "--rehearse", "1", "--markers", "udp://127.0.0.1:9", words=["--markers", "real output"])
    refuses(*study, "--rehearse", "1", "--hand", "leap://127.0.0.1:9", words=["--hand leap://127.0.0.1:9", "real time"])
    assert not (tmp_path / "answers").exists()


def test_wrong_checks_and_failed_practice_are_noted_and_can_be_excluded(prostm, tmp_path):
    protocol = CHECKS.replace("trials = 3\nright = 0", "trials = 2\nright = 1\nwindow = 2")
    (tmp_path / "study.toml").write_text(protocol)
    prostm("study", "preregister", "study.toml", "-o", "plan.jsonl", "--exclude-failed-practice", "--exclude-wrong-checks", "0.2")
    for participant in range(1, 9):
        rehearse(prostm, participant)
    failed = [n for n in range(1, 9) if not [line for line in lines_of(tmp_path, n) if line["kind"] == "practised"][0]["passed"]]
    assert 0 < len(failed) < 8  # answers are random
    files = [f"answers/rehearsal-{n}.jsonl" for n in range(1, 9)]
    said = prostm("study", "analyse", *files, "--plan", "plan.jsonl").stdout
    for n in range(1, 9):
        assert (f"Participant {n} did not reach the criterion of the practice with am." in said) == (n in failed)
    assert f"Practice without its criterion, left out: {', '.join(map(str, failed))}." in said
    assert "trials wrongly" not in said  # rehearsals answer catch and attention trials rightly
