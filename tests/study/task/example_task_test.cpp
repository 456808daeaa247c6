/// A task from outside prostm in all stages: protocol, session, file, analysis.

#include "study/task/example_task.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>

#include "prostm/core/file/file.hpp"
#include "prostm/study/analysis/analysis.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using Do = StudyAct::Do;

const std::string kText =
    "[training]\nseconds = 0\n"
    "[trials]\ntask = \"odd-one-out\"\nrest = 0.1\nsettle = 0.5\nfeedback = true\n"
    "[level]\nsetting = \"plan.speed\"\nlow = 2\nhigh = 8\nreference = 2\n"
    "procedure = \"bayes\"\ntrials = 30\ntracks = 3\ninterval = 1\ngap = 0.5\n"
    "[scene.one-plume]\nquestion = \"Which differs?\"\n[method.stm]\n";

Protocol odd_protocol() {
  return protocol_from_toml(kText, "p.toml", {}, test::tasks_with_odd_one_out());
}

/// A session in a run that obeys at once.
struct Sitting {
  explicit Sitting(const std::string& path)
      : protocol(odd_protocol()), file(path), session(protocol, 1, file, test::kFacts, sight) {}

  void pass() {
    sight.time += 0.1;
    sight.utc += 0.1;
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
  bool present() {
    if (session.phase() == StudyPhase::Ready) act({.what = Do::Next});
    return until([&] { return session.phase() == StudyPhase::Presenting; });
  }

  Protocol protocol;
  StudySight sight = test::sight_at(100.0);
  ResponseFile file;
  StudySession session;
};

TEST(ExampleTask, IsReadFromAProtocolIfItIsInTheTable) {
  EXPECT_THAT(test::input_error([] { protocol_from_toml(kText, "p.toml", {}); }),
              HasSubstr("line 4: trials.task"));
  const Protocol p = odd_protocol();
  EXPECT_EQ(p.trials.task->name(), "odd-one-out");
  EXPECT_EQ(protocol_json(p)["trials"]["task"], "odd-one-out");
  EXPECT_EQ(protocol_json(p)["level"]["reference"], 2.0);
}

TEST(ExampleTask, PresentsTheLevelInOneOfThreeIntervals) {
  const test::TemporaryFolder folder;
  Sitting s(folder.file("1.jsonl"));
  std::array<int, 4> places{};
  for (int trial = 0; trial < 12; ++trial) {
    ASSERT_TRUE(s.present());
    const Trial t = s.session.trial();
    for (int interval = 1; interval <= 3; ++interval) {
      ASSERT_TRUE(s.until([&] { return s.session.interval() == interval; }));
      EXPECT_EQ(s.session.wanted().level, interval == t.level_at ? *t.level : 2.0);
      if (interval < 3) {
        EXPECT_THAT(s.act({.what = Do::Answer, .interval = 1}), HasSubstr("all"));
      }
    }
    EXPECT_THAT(s.act({.what = Do::Answer, .yes = true}), HasSubstr("1 to 3"));
    EXPECT_EQ(s.act({.what = Do::Answer, .interval = t.level_at}), "");
    EXPECT_EQ(s.session.feedback(), true);
    EXPECT_THAT(s.act({.what = Do::Correct}), HasSubstr("only if there are two to choose from"));
    const ResponseLine& line = s.file.lines().back();
    EXPECT_EQ(line["interval"], t.level_at);
    EXPECT_EQ(line["answer"], t.level_at);
    EXPECT_EQ(line["correct"], 1);
    ++places[static_cast<std::size_t>(t.level_at)];
  }
  EXPECT_EQ(places[0], 0);
  for (int place = 1; place <= 3; ++place) EXPECT_GT(places[static_cast<std::size_t>(place)], 0);
}

/// Runs until the end, or until this many trials are done. @return whether the session is over.
bool sit(const std::string& path, SimulatedPerson& person, std::size_t trials) {
  Sitting s(path);
  while (s.session.phase() != StudyPhase::Done && s.session.trials_done() < trials) {
    if (s.session.phase() == StudyPhase::Ready) s.act({.what = Do::Next});
    if (s.session.takes_answer()) {
      EXPECT_EQ(s.act(person.act(s.session.trial())), "");
    } else {
      s.pass();
    }
  }
  return s.session.phase() == StudyPhase::Done;
}

TEST(ExampleTask, IsResumedReadBackAndAnalysed) {
  constexpr double kThreshold = 4.5;
  const test::TemporaryFolder folder;
  const std::string path = folder.file("1.jsonl");
  const Protocol p = odd_protocol();
  SimulatedPerson person(p, kThreshold, 7);
  EXPECT_FALSE(sit(path, person, 20));
  EXPECT_TRUE(sit(path, person, 1000));

  std::vector<std::string> notes;
  EXPECT_THAT(test::input_error([&] {
                read_answers({&path, 1}, notes);
              }),
              HasSubstr("task odd-one-out is unknown"));
  notes.clear();
  const std::vector<Answer> answers =
      read_answers({&path, 1}, notes, {}, test::tasks_with_odd_one_out());
  EXPECT_TRUE(notes.empty());
  ASSERT_EQ(answers.size(), 90U);
  EXPECT_EQ(answers.front().kind, AnswerKind::Right);
  const Analysis analysis = analyse(answers, {.chance = 1.0 / 3.0});
  ASSERT_FALSE(analysis.thresholds.empty());
  ASSERT_TRUE(analysis.thresholds.front().fit);
  EXPECT_NEAR(analysis.thresholds.front().fit->function.threshold, kThreshold, 0.5);
}

}  // namespace
}  // namespace prostm
