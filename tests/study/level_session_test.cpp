/// Sessions whose trials have levels: forced choice, judgement and adjustment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "prostm/core/file/file.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using Do = StudyAct::Do;

const std::string kShort = "[training]\nseconds = 0\n[trials]\nrest = 0.1\nsettle = 0.5\n";
const std::string kScene = "[scene.one-plume]\nquestion = \"Stronger?\"\n";
const std::string kLinear = "setting = \"plan.speed\"\nlow = 2\nhigh = 8\nstep = 0.3\n";
const std::string kAm = "[method.am.pipeline]\nmethod = \"am\"\n[method.stm]\n";

Protocol protocol(const std::string& trials, const std::string& level,
                  const std::string& methods = "[method.stm]\n") {
  return protocol_from_toml(kShort + trials + "[level]\n" + level + kScene + methods, "p.toml",
                            PipelineSettings{});
}
const std::string kForced = "task = \"forced-choice\"\n", kJudged = "task = \"judgement\"\n",
                  kAdjusted = "task = \"adjustment\"\nrepeats = 4\n";

/// A session in a run that obeys at once.
struct Sitting {
  Sitting(const Protocol& p, const std::string& path, double step = 0.1)
      : step_(step), protocol(p), file(path), session(protocol, 1, file, test::kFacts, sight) {}

  void pass() {
    sight.time += step_;
    sight.utc += step_;
    session.look(sight);
  }
  bool until(const std::function<bool()>& done) {
    for (int i = 0; i < 600; ++i) {
      if (done()) return true;
      pass();
    }
    return false;
  }
  std::string act(const StudyAct& a) { return session.take(a, sight); }
  std::string answer(int interval) { return act({.what = Do::Answer, .interval = interval}); }
  bool present() {
    if (session.phase() == StudyPhase::Ready) act({.what = Do::Next});
    return until([&] { return session.phase() == StudyPhase::Presenting; });
  }
  bool present_all() {
    return present() && until([&] { return session.takes_answer(); });
  }
  std::vector<ResponseLine> lines(const std::string& kind) const {
    std::vector<ResponseLine> found;
    for (const ResponseLine& line : file.lines())
      if (line["kind"] == kind) found.push_back(line);
    return found;
  }

  double step_;  // clock step [s]
  Protocol protocol;
  StudySight sight = test::sight_at(100.0);
  ResponseFile file;
  StudySession session;
};

TEST(LevelSession, PresentsTwoIntervalsWithAGapAndAcceptsTheAnswerAfterBothHaveStarted) {
  const test::TemporaryFolder folder;
  const Protocol p =
      protocol(kForced, kLinear + "reference = 2\ninterval = 1\ngap = 0.5\nreversals = 4\n");
  Sitting s(p, folder.file("1.jsonl"));
  int first = 0;
  for (int trial = 0; trial < 6; ++trial) {
    ASSERT_TRUE(s.present());
    const Trial t = s.session.trial();
    first += t.level_first() ? 1 : 0;
    const double levels[2] = {t.level_first() ? *t.level : 2.0, t.level_first() ? 2.0 : *t.level};
    EXPECT_EQ(s.session.interval(), 1);
    EXPECT_EQ(s.session.wanted().level, levels[0]);
    EXPECT_TRUE(s.session.wanted().sound);
    EXPECT_THAT(s.answer(1), HasSubstr("both intervals"));
    ASSERT_TRUE(s.until([&] { return s.session.interval() == 0; }));
    EXPECT_FALSE(s.session.wanted().sound);
    EXPECT_EQ(s.session.wanted().level, levels[1]) << "prepared in the gap";
    s.sight.in_force = false;
    for (int i = 0; i < 20; ++i) s.pass();
    EXPECT_EQ(s.session.interval(), 0) << "until it is in force";
    s.sight.in_force = true;
    ASSERT_TRUE(s.until([&] { return s.session.interval() == 2; }));
    EXPECT_TRUE(s.session.wanted().sound);
    EXPECT_THAT(s.act({.what = Do::Answer, .yes = true}), HasSubstr("an interval"));
    if (trial % 2 == 0) {
      ASSERT_TRUE(s.until([&] { return !s.session.wanted().sound; }));
    }
    const int chosen = trial == 3 ? (t.level_first() ? 2 : 1) : (t.level_first() ? 1 : 2);
    EXPECT_EQ(s.answer(chosen), "");
    const ResponseLine line = s.lines("trial").back();
    EXPECT_EQ(line["interval"], t.level_first() ? 1 : 2);
    EXPECT_EQ(line["answer"], chosen);
    EXPECT_EQ(line["felt"], trial == 3 ? 0 : 1);
    EXPECT_EQ(line["correct"], trial == 3 ? 0 : 1);
    EXPECT_EQ(line["level"], *t.level);
    EXPECT_EQ(line["reference"], 2.0);
    EXPECT_EQ(line["track"], 1);
    EXPECT_FALSE(line.contains("question"));
  }
  EXPECT_GT(first, 0);
  EXPECT_LT(first, 6);
}

TEST(LevelSession, ComparisonsWithAnotherMethodHaveNoRightAnswers) {
  const test::TemporaryFolder folder;
  const Protocol p = protocol(kForced, kLinear + "against = \"am\"\nshare = 0.5\n", kAm);
  Sitting s(p, folder.file("1.jsonl"));
  ASSERT_TRUE(s.present());
  const bool level_first = s.session.trial().level_first();
  EXPECT_EQ(s.session.wanted().standard, !level_first);
  EXPECT_EQ(s.session.wanted().level.has_value(), level_first);
  ASSERT_TRUE(s.until([&] { return s.session.interval() == 2; }));
  EXPECT_EQ(s.session.wanted().standard, level_first);
  s.answer(1);
  const ResponseLine line = s.lines("trial").back();
  EXPECT_EQ(line["reference"], "am");
  EXPECT_EQ(line["felt"], level_first ? 1 : 0);
  EXPECT_FALSE(line.contains("correct"));
}

TEST(LevelSession, AJudgementLowersTheLevelAfterYesAndRaisesItAfterNo) {
  const test::TemporaryFolder folder;
  Sitting s(protocol(kJudged, kLinear + "start = 5\nshare = 0.5\ncoarse = 0\ninterval = 1\n"),
            folder.file("1.jsonl"));
  double expected = 5.0;
  for (const bool yes : {true, true, false, true}) {
    ASSERT_TRUE(s.present());
    EXPECT_NEAR(*s.session.wanted().level, expected, 1e-5);
    EXPECT_THAT(s.answer(1), HasSubstr("yes or no"));
    EXPECT_THAT(s.act({.what = Do::Accept}), HasSubstr("not possible now"));
    EXPECT_EQ(s.act({.what = Do::Answer, .yes = yes}), "");
    expected += yes ? -0.3 : 0.3;
  }
  EXPECT_EQ(s.lines("trial").back()["answer"], 1);
}

TEST(LevelSession, ACorrectionChangesTheNextLevel) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  const Protocol p = protocol(kJudged, kLinear + "start = 5\nshare = 0.5\ncoarse = 0\n");
  double next = 0.0;
  {
    Sitting s(p, path);
    ASSERT_TRUE(s.present());
    s.act({.what = Do::Answer, .yes = true});
    s.until([&] { return s.session.wanted().level.has_value(); });
    EXPECT_NEAR(*s.session.wanted().level, 4.7, 1e-9);
    EXPECT_EQ(s.act({.what = Do::Correct}), "");
    EXPECT_FALSE(s.session.wanted().level) << "the trial is prepared again";
    ASSERT_TRUE(s.present());
    next = *s.session.wanted().level;
    EXPECT_NEAR(next, 5.3, 1e-9);
  }
  Sitting s(p, path);
  ASSERT_TRUE(s.present());
  EXPECT_EQ(*s.session.wanted().level, next);
}

TEST(LevelSession, AnAdjustmentAlternatesWithTheStandardAndRecordsEveryChange) {
  const test::TemporaryFolder folder;
  Sitting s(protocol(kAdjusted, kLinear + "against = \"am\"\ninterval = 1\ngap = 0.5\n", kAm),
            folder.file("1.jsonl"));
  EXPECT_EQ(s.session.course().most(), 4U);
  ASSERT_TRUE(s.present());
  const double start = *s.session.trial().level;
  EXPECT_THAT(s.act({.what = Do::Accept}), HasSubstr("both intervals must be felt"));
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(s.until([&] { return s.session.interval() == 1; }));
    EXPECT_TRUE(s.session.wanted().standard);
    ASSERT_TRUE(s.until([&] { return s.session.interval() == 2; }));
    EXPECT_FALSE(s.session.wanted().standard);
    EXPECT_EQ(s.session.wanted().level, s.session.trial().level);
    const int way = start < 6.0 ? 1 : -1;
    EXPECT_EQ(s.act({.what = Do::Tune, .steps = way, .coarse = round == 0}), "");
    EXPECT_EQ(s.session.wanted().level, s.session.trial().level) << "at once";
  }
  const double end = *s.session.trial().level;
  EXPECT_NEAR(std::abs(end - start), 0.3 * (4 + 1 + 1), 1e-4);
  EXPECT_THAT(s.act({.what = Do::Answer, .yes = true}), HasSubstr("tune it and accept"));
  EXPECT_EQ(s.act({.what = Do::Accept}), "");
  const ResponseLine line = s.lines("trial").back();
  EXPECT_EQ(line["start"], start);
  EXPECT_EQ(line["level"], end);
  ASSERT_EQ(line["changes"].size(), 3U);
  EXPECT_EQ(line["changes"][2][1], end);
  EXPECT_EQ(line["reference"], "am");
  EXPECT_FALSE(line.contains("answer"));
  EXPECT_THAT(s.act({.what = Do::Correct}), HasSubstr("not possible now"));
}

/// All fields except those that differ when a trial is presented again.
std::vector<nlohmann::ordered_json> trials_of(const std::string& path) {
  std::vector<nlohmann::ordered_json> out;
  for (const ResponseLine& line : responses_from_text(read_file(path), path)) {
    if (line["kind"] != "trial") continue;
    nlohmann::ordered_json& kept = out.emplace_back();
    for (const char* key : {"trial", "track", "level", "interval", "answer", "felt", "stimulus"})
      if (line.contains(key)) kept[key] = line[key];
  }
  return out;
}

/// An action that depends on the trial alone.
StudyAct steady(const StudySession& session) {
  const Trial& t = session.trial();
  if (session.protocol().trials.task == &adjustment()) {
    if (std::abs(*t.level - 6.0) < 0.2) return {.what = Do::Accept};
    return {.what = Do::Tune, .steps = *t.level < 6.0 ? 1 : -1};
  }
  const bool felt = *t.level > 5.0;
  if (session.protocol().trials.task == &judgement()) return {.what = Do::Answer, .yes = felt};
  return {.what = Do::Answer, .interval = felt == t.level_first() ? 1 : 2};
}

TEST(LevelSession, ResumesAfterBeingKilledAtAnyStep) {
  const test::TemporaryFolder folder;
  const std::string few = "reversals = 5\ntracks = 2\n";
  const Protocol protocols[] = {
      protocol(kForced, kLinear + "reference = 2\n" + few),
      protocol(kForced, kLinear + "against = \"am\"\nprocedure = \"bayes\"\ntrials = 9\n", kAm),
      protocol(kJudged, kLinear + few), protocol(kAdjusted, kLinear + "against = \"am\"\n", kAm)};
  for (const Protocol& p : protocols) {
    const std::string whole = folder.file("whole.jsonl");
    {
      Sitting s(p, whole);
      while (s.session.phase() != StudyPhase::Done) {
        ASSERT_TRUE(s.present_all());
        ASSERT_EQ(s.act(steady(s.session)), "");
      }
    }
    const auto expected = trials_of(whole);
    ASSERT_GT(expected.size(), 3U);
    std::filesystem::remove(whole);
    // killed after a few actions and steps, in any phase
    for (const int life : {1, 3, 7, 20, 55}) {
      const std::string path = folder.file("killed.jsonl");
      std::size_t known = 0;
      for (bool done = false; !done;) {
        Sitting s(p, path);
        ASSERT_EQ(s.session.trials_done(), known) << "nothing is lost or doubled";
        // a run lasts longer while there is no progress
        for (int i = 0; !done && (i < life || s.session.trials_done() == known); ++i) {
          if (s.session.phase() == StudyPhase::Ready) s.act({.what = Do::Next});
          if (s.session.takes_answer()) s.act(steady(s.session));
          s.pass();
          done = s.session.phase() == StudyPhase::Done;
        }
        known = s.session.trials_done();
      }
      EXPECT_EQ(trials_of(path), expected) << life;
      EXPECT_THAT(test::input_error([&] { Sitting s(p, path); }),
                  HasSubstr("has given all answers"));
      std::filesystem::remove(path);
    }
  }
}

TEST(LevelSession, ReportsLevelsInAFileThatItsStaircaseDidNotRequest) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  const Protocol p = protocol(kJudged, kLinear);
  {
    Sitting s(p, path);
    ASSERT_TRUE(s.present());
    s.act({.what = Do::Answer, .yes = true});
  }
  std::vector<ResponseLine> lines = responses_from_text(read_file(path), path);
  std::filesystem::remove(path);
  {
    ResponseFile other(path);
    for (ResponseLine& line : lines) {
      if (line["kind"] == "trial") line["level"] = 3.0;
      other.append(line);
    }
  }
  EXPECT_THAT(test::input_error([&] { Sitting s(p, path); }),
              HasSubstr("trial 1 has level 3, but its staircase asks for 8"));
}

// ---- results of sessions ----

/// Mean and spread of the results of sessions, relative to the truth.
struct Found {
  double bias = 0.0, spread = 0.0;
};

/// A folder in memory, if the machine has one: 1000 sessions sync every line.
std::string in_memory(const std::string& name) {
  const bool there = std::filesystem::is_directory("/dev/shm");
  return ((there ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path()) /
          ("prostm-" + std::to_string(::getpid()) + name))
      .string();
}

/// 1000 complete sessions of a simulated person, on a simulated clock.
Found find(const Protocol& p, double truth) {
  constexpr int kRuns = 1000;
  double sum = 0.0, squares = 0.0;
  const std::string path = in_memory("levels.jsonl");
  for (int run = 0; run < kRuns; ++run) {
    Protocol own = p;
    own.study.seed = run;
    {
      Sitting s(own, path, 1.0);
      SimulatedPerson person(own, truth, static_cast<std::uint64_t>(run));
      s.sight.palm = Pose::Identity();
      while (s.session.phase() != StudyPhase::Done) {
        if (s.session.phase() == StudyPhase::Ready) s.act({.what = Do::Next});
        if (s.session.takes_answer()) {
          s.act(person.act(s.session.trial()));
        } else {
          s.pass();
        }
      }
      const double off = s.session.course().result(1) / truth - 1.0;
      sum += off;
      squares += off * off;
    }
    std::filesystem::remove(path);
  }
  const Found found{sum / kRuns, std::sqrt(squares / kRuns - sum * sum / kRuns / kRuns)};
  testing::Test::RecordProperty("bias", std::to_string(found.bias));
  testing::Test::RecordProperty("spread", std::to_string(found.spread));
  return found;
}

const std::string kGain = "setting = \"plan.speed\"\nlow = 1\nhigh = 4\nscale = \"log\"\n";

TEST(LevelSession, UpDownFindsAKnownThreshold) {
  const Protocol p = protocol(kForced, kGain +
                                           "reference = 1\nstep = 0.03\nreversals = 22\n"
                                           "trials = 200\n");
  const Found found = find(p, 2.0);
  EXPECT_LT(std::abs(found.bias), 0.05);
  EXPECT_LT(found.spread, 0.10);
}

TEST(LevelSession, BayesFindsAKnownThreshold) {
  const Protocol p =
      protocol(kJudged, kGain + "procedure = \"bayes\"\ntrials = 40\ninterval = 1\n");
  const Found found = find(p, 2.2);
  EXPECT_LT(std::abs(found.bias), 0.05);
  EXPECT_LT(found.spread, 0.10);
}

TEST(LevelSession, AdjustmentFindsTheMatch) {
  const Protocol p = protocol("task = \"adjustment\"\nrepeats = 4\n",
                              kGain + "against = \"am\"\nstep = 0.02\n", kAm);
  const Found found = find(p, 1.8);
  EXPECT_LT(std::abs(found.bias), 0.05);
  EXPECT_LT(found.spread, 0.10);
}

TEST(LevelSession, CanBeRehearsedToItsEnd) {
  const test::TemporaryFolder folder;
  const Protocol protocols[] = {protocol(kForced, kLinear + "reference = 2\nreversals = 6\n"),
                                protocol(kJudged, kLinear + "reversals = 6\n"),
                                protocol(kAdjusted, kLinear + "reference = 6\n")};
  for (const Protocol& p : protocols) {
    const std::string path = folder.file("r.jsonl");
    {
      Sitting s(p, path);
      Rehearsal rehearsal(0, 1);
      bool closed = false;
      for (int i = 0; i < 20'000 && !closed; ++i) {
        const auto act = rehearsal.act(s.session, s.sight.time);
        if (act) s.act(*act);
        s.pass();
        closed = s.session.closed();
      }
      EXPECT_TRUE(closed);
      EXPECT_EQ(s.session.phase(), StudyPhase::Done);
      EXPECT_GT(s.lines("trial").size(), 3U);
    }
    std::filesystem::remove(path);
  }
}

/// All messages of a session to the experimenter, and how often a word occurs in them.
int count_news(Sitting& s, const std::string& word) {
  int count = 0;
  for (std::string news; s.session.next_news(news);) count += news.find(word) != std::string::npos;
  return count;
}

TEST(LevelSession, ReportsAStaircaseAtALimitOfItsRange) {
  const test::TemporaryFolder folder;
  for (const bool yes : {true, false}) {
    for (const char* procedure : {"up-down", "bayes"}) {
      const Protocol p = protocol(kJudged, kLinear + "procedure = \"" + procedure + "\"\n");
      Sitting s(p, folder.file(std::string(procedure) + (yes ? "y" : "n")));
      int told = 0;
      for (int trial = 0; trial < 60 && s.session.phase() != StudyPhase::Done; ++trial) {
        ASSERT_TRUE(s.present());
        s.act({.what = Do::Answer, .yes = yes});
        told += count_news(s, "end of its range");
      }
      EXPECT_EQ(told, 1);
      const auto bounds = s.lines("bound");
      ASSERT_EQ(bounds.size(), 1U) << "recorded once";
      EXPECT_EQ(bounds[0]["bound"], yes ? "low" : "high");
      EXPECT_EQ(bounds[0]["answers"], 3);
      EXPECT_THAT(s.session.at_bound(), HasSubstr("end of its range"));
      EXPECT_EQ(s.session.at_bound().find("low"), std::string::npos) << "the study is blind";
    }
  }
}

TEST(LevelSession, DoesNotReportABoundThatAnswersLeave) {
  const test::TemporaryFolder folder;
  const Protocol p = protocol(kJudged, kLinear);
  Sitting s(p, folder.file("1.jsonl"));
  for (int trial = 0; trial < 40 && s.session.phase() != StudyPhase::Done; ++trial) {
    ASSERT_TRUE(s.present());
    s.act({.what = Do::Answer, .yes = trial % 3 != 0});
    EXPECT_EQ(s.session.at_bound(), "");
  }
  EXPECT_TRUE(s.lines("bound").empty());
}

TEST(LevelSession, ReportsAnAdjustmentAcceptedAtALimitOfItsRange) {
  const test::TemporaryFolder folder;
  const Protocol p = protocol(kAdjusted, kLinear + "against = \"am\"\n", kAm);
  Sitting s(p, folder.file("1.jsonl"));
  ASSERT_TRUE(s.present_all());
  s.act({.what = Do::Tune, .steps = 1000});
  s.act({.what = Do::Accept});
  EXPECT_THAT(s.session.at_bound(), HasSubstr("accepted at an end"));
  EXPECT_EQ(s.lines("bound")[0]["bound"], "high");
}

}  // namespace
}  // namespace prostm
