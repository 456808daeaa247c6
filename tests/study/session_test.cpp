#include "prostm/study/session/session.hpp"

#include <functional>
#include <memory>

#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "study/study_support.hpp"
#include "support/full_disk.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using Do = StudyAct::Do;

/// A session with its file, in a run that obeys at once.
struct Sitting {
  Sitting(const Protocol& p, const std::string& path, int participant = 1)
      : protocol(p), file(path), session(protocol, participant, file, test::kFacts, sight) {}

  /// Lets time pass in steps of 50 ms until a condition holds.
  bool until(const std::function<bool()>& done, double seconds = 30.0) {
    for (int i = 0; i < 20 * seconds; ++i) {
      if (done()) return true;
      pass(0.05);
    }
    return false;
  }
  bool until(StudyPhase phase) {
    return until([&] { return session.phase() == phase; });
  }
  void pass(double seconds) {
    sight.time += seconds;
    sight.utc += seconds;
    session.look(sight);
  }
  std::string act(Do what) { return session.take({.what = what}, sight); }
  std::string answer(bool yes) { return session.take({.what = Do::Answer, .yes = yes}, sight); }
  /// Advances from any phase to the presentation of the next trial.
  bool present() {
    if (session.phase() == StudyPhase::Training) act(Do::EndTraining);
    if (session.phase() != StudyPhase::Settling) act(Do::Next);
    return until(StudyPhase::Presenting);
  }
  bool right() const { return session.trial().scene == session.trial().question; }

  Protocol protocol;
  StudySight sight = test::sight_at(100.0);
  ResponseFile file;
  StudySession session;
};

std::vector<ResponseLine> lines_of(const ResponseFile& file, const std::string& kind) {
  std::vector<ResponseLine> lines;
  for (const ResponseLine& line : file.lines())
    if (line["kind"] == kind) lines.push_back(line);
  return lines;
}

TEST(StudySession, LeadsFromTrainingToTheLastAnswer) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol(), folder.file("1.jsonl"));
  EXPECT_EQ(s.session.phase(), StudyPhase::Training);
  EXPECT_TRUE(s.session.wanted().picture);
  EXPECT_TRUE(s.session.wanted().sound);
  EXPECT_EQ(s.session.take({.what = Do::Explore, .scene = 1}, s.sight), "");
  EXPECT_EQ(s.session.wanted().scene, 1);
  s.pass(100.0);
  EXPECT_EQ(s.session.phase(), StudyPhase::Training);
  s.pass(21.0);
  ASSERT_EQ(s.session.phase(), StudyPhase::Ready);
  EXPECT_FALSE(s.session.wanted().picture);
  EXPECT_FALSE(s.session.wanted().sound);
  const auto order = trial_order(s.protocol, 1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_TRUE(s.present());
    EXPECT_EQ(s.session.trial(), order[i]);
    EXPECT_EQ(s.session.wanted(), (StudyWanted{order[i].method, order[i].scene, true, false}));
    s.pass(2.0);
    EXPECT_EQ(s.answer(i % 3 == 0), "");
    EXPECT_FALSE(s.session.wanted().sound);
  }
  EXPECT_EQ(s.session.phase(), StudyPhase::Done);
  EXPECT_FALSE(s.session.feedback());
  const auto trials = lines_of(s.file, "trial");
  ASSERT_EQ(trials.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const ResponseLine& line = trials[i];
    EXPECT_EQ(line["trial"], i + 1);
    EXPECT_EQ(line["scene"], s.protocol.scenes[static_cast<std::size_t>(order[i].scene)].name);
    EXPECT_EQ(line["answer"], i % 3 == 0 ? 1 : 0);
    EXPECT_EQ(line["correct"], (i % 3 == 0) == (order[i].scene == order[i].question) ? 1 : 0);
    EXPECT_NEAR(line["response_s"].get<double>(), 2.0, 1e-9);
    EXPECT_NEAR(line["rendered_mn"].get<double>(), 0.4, 1e-9);
    EXPECT_EQ(line["hand"][0].size(), 8U);
    EXPECT_EQ(line["hand"][0][3], 200.0);
  }
  EXPECT_EQ(lines_of(s.file, "end").size(), 1U);
}

TEST(StudySession, ClearsTheAirInSilenceBeforeEachTrialAndSettlesIt) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n[trials]\nsettle = 3\n"),
            folder.file("1.jsonl"));
  ASSERT_EQ(s.session.phase(), StudyPhase::Ready);
  s.act(Do::Next);
  s.pass(0.9);
  EXPECT_EQ(s.session.wanted().scene, -1);
  s.pass(0.2);
  EXPECT_EQ(s.session.wanted().scene, s.session.trial().scene);
  s.sight.in_force = false;
  for (int i = 0; i < 10; ++i) s.pass(1.0);
  EXPECT_EQ(s.session.phase(), StudyPhase::Settling);
  s.sight.in_force = true;
  s.pass(0.1);
  s.pass(2.9);
  EXPECT_EQ(s.session.phase(), StudyPhase::Settling);
  s.pass(0.2);
  EXPECT_EQ(s.session.phase(), StudyPhase::Presenting);
}

TEST(StudySession, WaitsForTheGateUnlessOverridden) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n"), folder.file("1.jsonl"));
  GateResult gate;
  gate.finding.problem = GateProblem::Tilted;
  gate.finding.value = 0.5;
  s.sight.gate = gate;
  s.act(Do::Next);
  EXPECT_FALSE(s.until(StudyPhase::Presenting));
  EXPECT_EQ(s.session.waits_for(), sentence(gate));
  s.sight.palm.reset();
  s.pass(0.1);
  EXPECT_THAT(s.session.waits_for(), HasSubstr("no hand"));
  EXPECT_EQ(s.session.wanted().scene, -1);
  s.sight.palm = Pose::Identity();
  s.act(Do::Anyway);
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  s.answer(true);
  EXPECT_FALSE(s.until(StudyPhase::Presenting)) << "overridden once only";
  gate.pass = true;
  s.sight.gate = gate;
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  s.answer(true);
  const auto trials = lines_of(s.file, "trial");
  EXPECT_EQ(trials[0]["gate"]["pass"], false);
  EXPECT_EQ(trials[0]["gate"]["problem"], "tilted");
  EXPECT_EQ(trials[0]["anyway"], true);
  EXPECT_EQ(trials[1]["gate"]["pass"], true);
  EXPECT_EQ(trials[1]["anyway"], false);
}

TEST(StudySession, RecordsAGateThatIsNotRequired) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n[trials]\ngate = \"noted\"\n"),
            folder.file("1.jsonl"));
  s.sight.gate = GateResult{};
  ASSERT_TRUE(s.present());
  s.answer(false);
  EXPECT_EQ(lines_of(s.file, "trial")[0]["gate"]["pass"], false);
}

TEST(StudySession, CorrectsTheLastAnswerUntilTheNextQuestion) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  const Protocol p = test::study_protocol("[training]\nseconds = 0\n[trials]\nfeedback = true\n");
  {
    Sitting s(p, path);
    EXPECT_THAT(s.act(Do::Correct), HasSubstr("not possible now"));
    ASSERT_TRUE(s.present());
    const bool right = s.right();
    s.answer(true);
    EXPECT_EQ(s.act(Do::Correct), "");
    EXPECT_EQ(s.session.last_answer(), false);
    EXPECT_EQ(s.session.feedback(), !right);
    ASSERT_TRUE(s.until(StudyPhase::Presenting));
    EXPECT_THAT(s.act(Do::Correct), HasSubstr("not possible now"));
  }
  Sitting s(p, path);
  EXPECT_EQ(s.session.last_answer(), false);
  s.act(Do::Correct);
  s.act(Do::Correct);
  std::vector<std::string> notes;
  const auto answers = answers_from_responses(read_file(path), path, notes);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].yes);
  EXPECT_EQ(answers[0].correct, answers[0].scene != answers[0].question);
}

TEST(StudySession, PresentsATrialAgainAfterAPause) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n"), folder.file("1.jsonl"));
  ASSERT_TRUE(s.present());
  const Trial before = s.session.trial();
  EXPECT_EQ(s.act(Do::Pause), "");
  EXPECT_FALSE(s.session.wanted().sound);
  EXPECT_THAT(s.answer(true), HasSubstr("not possible now"));
  ASSERT_TRUE(s.present());
  EXPECT_EQ(s.session.trial(), before);
  EXPECT_TRUE(lines_of(s.file, "trial").empty());
}

TEST(StudySession, EndsAStimulusAtItsTimeLimitAndAcceptsAnswersAfterIt) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n[trials]\ntime_limit = 1.5\n"),
            folder.file("1.jsonl"));
  ASSERT_TRUE(s.present());
  s.pass(1.4);
  EXPECT_TRUE(s.session.wanted().sound);
  s.pass(0.2);
  EXPECT_FALSE(s.session.wanted().sound);
  s.pass(3.0);
  EXPECT_EQ(s.answer(true), "");
  EXPECT_NEAR(lines_of(s.file, "trial")[0]["response_s"].get<double>(), 4.6, 1e-9);
}

TEST(StudySession, HasBreaksFeedbackConsentAndQuestionsIfConfigured) {
  const test::TemporaryFolder folder;
  Protocol p = test::study_protocol(
      "consent = \"I agree\"\ndemographics = true\n[training]\nseconds = 0\n[trials]\n"
      "break_every = 3\nfeedback = true\n");
  Sitting s(p, folder.file("1.jsonl"));
  EXPECT_EQ(s.session.phase(), StudyPhase::Consent);
  EXPECT_THAT(s.act(Do::Next), HasSubstr("not possible now"));
  s.act(Do::Consent);
  EXPECT_EQ(s.session.phase(), StudyPhase::About);
  s.session.take({.what = Do::About, .about = {{"hand", "left"}}}, s.sight);
  EXPECT_EQ(lines_of(s.file, "about")[0]["answers"]["hand"], "left");
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(s.present());
    const bool right = s.right();
    s.answer(true);
    EXPECT_EQ(s.session.feedback(), right);
  }
  EXPECT_EQ(s.session.phase(), StudyPhase::Break);
  EXPECT_FALSE(s.until(StudyPhase::Presenting));
  EXPECT_TRUE(s.present());
}

TEST(StudySession, TrainsBeforeEachMethodWithinParticipants) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("methods = \"within\"\n[trials]\nrepeats = 1\n"),
            folder.file("1.jsonl"));
  const int first = s.session.wanted().method;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(s.present());
    s.answer(true);
  }
  ASSERT_EQ(s.session.phase(), StudyPhase::Training);
  EXPECT_EQ(s.session.wanted().method, 1 - first);
  EXPECT_EQ(s.session.training_left(), 120.0);
}

TEST(StudySession, ResumesAfterBeingKilledAnywhere) {
  const test::TemporaryFolder folder;
  Random random(5);
  const Protocol p = test::study_protocol("methods = \"within\"\n[trials]\nrepeats = 3\n");
  for (int run = 0; run < 60; ++run) {
    const std::string path = folder.file(std::to_string(run) + ".jsonl");
    std::size_t known = 0;
    bool done = false;
    while (!done) {
      Sitting s(p, path);
      ASSERT_EQ(s.session.trials_done(), known) << "nothing is lost or doubled";
      const int acts = random.below(5);
      for (int i = 0; i < acts && !done; ++i) {
        ASSERT_TRUE(s.present());
        s.answer(random.below(2) == 0);
        ++known;
        done = s.session.phase() == StudyPhase::Done;
      }
      if (!done && random.below(2) == 0) s.present();
    }
    EXPECT_THAT(test::input_error([&] { Sitting s(p, path); }), HasSubstr("has given all answers"));
    const auto order = trial_order(p, 1);
    const ResponseFile file(path);
    const auto trials = lines_of(file, "trial");
    ASSERT_EQ(trials.size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(trials[i]["trial"], i + 1);
  }
}

TEST(StudySession, RepeatsATrainingInWhichItWasKilled) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  {
    Sitting s(test::study_protocol(), path);
    s.pass(50.0);
  }
  Sitting s(test::study_protocol(), path);
  EXPECT_EQ(s.session.phase(), StudyPhase::Training);
  EXPECT_EQ(s.session.training_left(), 120.0);
  EXPECT_EQ(s.session.wanted(), (StudyWanted{trial_order(s.protocol, 1)[0].method, 0, true, true}));
}

TEST(StudySession, ResumesOnlyWithItsOwnProtocolAndParticipant) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  { const Sitting s(test::study_protocol(), path); }
  EXPECT_THAT(test::input_error([&] { Sitting s(test::study_protocol(), path, 2); }),
              HasSubstr("another participant"));
  EXPECT_THAT(test::input_error([&] { Sitting s(test::study_protocol("blind = false\n"), path); }),
              HasSubstr("another protocol"));
  {
    Sitting s(test::study_protocol(), path);
    s.act(Do::Withdraw);
  }
  EXPECT_THAT(test::input_error([&] { Sitting s(test::study_protocol(), path); }),
              HasSubstr("left"));
}

TEST(StudySession, DoesNotResumeFromTrialsThatLackAValue) {
  const Protocol protocol = test::study_protocol("[training]\nseconds = 0\n");
  for (const char* key : {"answer", "target_mn", "rendered_mn"}) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("1.jsonl");
    std::vector<ResponseLine> lines;
    {
      Sitting s(protocol, folder.file("whole.jsonl"));
      ASSERT_TRUE(s.present());
      ASSERT_EQ(s.answer(true), "");
      lines = s.file.lines();
    }
    {
      ResponseFile file(path);
      for (ResponseLine& line : lines) {
        if (line["kind"] == "trial") line.erase(key);
        file.append(line);
      }
    }
    EXPECT_THAT(test::input_error([&] { Sitting s(protocol, path); }),
                HasSubstr(std::string("trial 1 has no number \"") + key));
  }
}

TEST(StudySession, KeepsAnswersWhileTheDiskIsFull) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[training]\nseconds = 0\n"), folder.file("1.jsonl"));
  ASSERT_TRUE(s.present());
  {
    const test::FullDisk full(read_file(s.file.path()).size() + 5);
    EXPECT_THAT(s.answer(true), HasSubstr("could not be written"));
    EXPECT_THAT(s.session.problem(), HasSubstr("could not be written"));
    EXPECT_FALSE(s.until(StudyPhase::Presenting)) << "the answer must be on the disk first";
    EXPECT_THAT(s.session.finish(s.sight.time), HasSubstr("could not be written"));
    EXPECT_EQ(s.session.unwritten().size(), 1U);
    EXPECT_EQ(lines_of(s.file, "trial").size(), 0U) << "only trials on the disk are counted";
  }
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  EXPECT_EQ(s.session.problem(), "");
  EXPECT_TRUE(s.session.unwritten().empty());
  EXPECT_EQ(lines_of(s.file, "trial").size(), 1U);
}

TEST(StudySession, RecordsAJumpOfTheWallClock) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol(), folder.file("1.jsonl"));
  s.pass(1.0);
  s.sight.utc -= 3600.0;
  s.pass(1.0);
  s.pass(1.0);
  const auto jumps = lines_of(s.file, "clock");
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0]["jump_s"], -3600.0);
}

TEST(StudySession, ReportsThatConditionsDifferInStrength) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  const Protocol p = test::study_protocol("[training]\nseconds = 0\n[trials]\nrepeats = 2\n");
  for (int i = 0; i < 2; ++i) {
    Sitting s(p, path);
    for (int trial = 0; trial < 2; ++trial) {
      ASSERT_TRUE(s.present());
      s.sight.rendered_force = s.session.trial().scene == 0 ? 4e-4 : 3e-4;
      s.pass(1.0);
      s.pass(1.0);
      s.answer(true);
    }
    EXPECT_THAT(
        s.session.strengths(),
        i == 0 ? testing::_ : testing::Matcher<std::string>(HasSubstr("strength may be a cue")));
  }
}

TEST(StudySession, ActionsNeverCorruptItsState) {
  const test::TemporaryFolder folder;
  Random random(7);
  for (int run = 0; run < 40; ++run) {
    const std::string path = folder.file(std::to_string(run) + "r.jsonl");
    Sitting s(test::study_protocol("consent = \"?\"\ndemographics = true\n[training]\nseconds = "
                                   "2\n[trials]\nrepeats = 2\nbreak_every = 2\n"),
              path);
    std::size_t done = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto what = static_cast<Do>(random.below(random.below(50) == 0 ? 9 : 8));
      const bool presenting = s.session.phase() == StudyPhase::Presenting;
      const std::string refused =
          s.session.take({what, random.below(2) == 0, random.below(4) - 1, {}}, s.sight);
      if (what == Do::Answer && presenting) ++done;
      ASSERT_TRUE(what != Do::Answer || refused.empty() == presenting);
      ASSERT_EQ(s.session.trials_done(), done);
      ASSERT_EQ(s.session.wanted().sound && s.session.phase() != StudyPhase::Training,
                s.session.phase() == StudyPhase::Presenting);
      s.sight.palm = random.below(3) == 0 ? std::nullopt : std::optional(Pose::Identity());
      s.pass(0.5 * random.uniform());
    }
  }
}

TEST(StudySession, CanBeRehearsedToItsEnd) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("consent = \"?\"\ndemographics = true\n[trials]\nrepeats = "
                                 "2\nbreak_every = 2\n"),
            folder.file("1.jsonl"));
  GateResult gate;
  gate.finding.problem = GateProblem::Tilted;
  s.sight.gate = gate;
  Rehearsal rehearsal(0, 1);
  const auto closes = [&] {
    const auto act = rehearsal.act(s.session, s.sight.time);
    if (act) s.session.take(*act, s.sight);
    return s.session.closed();
  };
  EXPECT_TRUE(s.until(closes, 120.0));
  EXPECT_EQ(s.session.phase(), StudyPhase::Done);
  EXPECT_EQ(lines_of(s.file, "trial").size(), 4U);

  Sitting other(test::study_protocol(), folder.file("2.jsonl"), 2);
  Rehearsal part(3, 1);
  EXPECT_TRUE(other.until(
      [&] {
        const auto act = part.act(other.session, other.sight.time);
        if (act) other.session.take(*act, other.sight);
        return part.is_done();
      },
      120.0));
  EXPECT_EQ(lines_of(other.file, "trial").size(), 3U);

  other.sight.palm.reset();
  Rehearsal without_hand(1, 1);
  EXPECT_TRUE(other.until(
      [&] {
        const auto act = without_hand.act(other.session, other.sight.time);
        if (act) other.session.take(*act, other.sight);
        return without_hand.is_done();
      },
      120.0));
  EXPECT_EQ(lines_of(other.file, "trial").size(), 3U);
}

TEST(StudySession, ReportsTheTimeOfDay) {
  EXPECT_EQ(utc_text(0.0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(utc_text(1700000000.25), "2023-11-14T22:13:20.250Z");
}

}  // namespace
}  // namespace prostm
