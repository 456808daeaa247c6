#include "prostm/study/extra/extra_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/task.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using Do = StudyAct::Do;

const std::string kShort = "[training]\nseconds = 0\n[trials]\nrest = 0.1\nsettle = 0.5\n";
const std::string kLevels =
    "[level]\nsetting = \"plan.speed\"\nlow = 2\nhigh = 8\nstep = 0.3\nreversals = 4\n";

Protocol with_levels(const std::string& task, const std::string& more = "",
                     const std::string& level = "") {
  return protocol_from_toml(kShort + "task = \"" + task + "\"\n" + more + kLevels + level +
                                "[scene.one-plume]\nquestion = \"Stronger?\"\n[method.stm]\n",
                            "p.toml", PipelineSettings{});
}

/// A session in a run that obeys at once.
struct Sitting {
  Sitting(const Protocol& p, const std::string& path, int participant = 1)
      : protocol(p), file(path), session(protocol, participant, file, test::kFacts, sight) {}

  void pass(double seconds = 0.1) {
    sight.time += seconds;
    sight.utc += seconds;
    session.look(sight);
  }
  std::string act(Do what) { return session.take({.what = what}, sight); }
  std::string answer(int number) { return session.take(act_for(number), sight); }
  /// Advances until an answer is taken. @return false in another phase, e.g. after the last trial.
  bool present() {
    if (session.phase() == StudyPhase::Ready) act(Do::Next);
    for (int i = 0; i < 600 && !session.takes_answer(); ++i) pass();
    return session.takes_answer();
  }
  /// The right answer to the trial.
  int right() const {
    if (session.extra() && session.extra()->wanted) return *session.extra()->wanted;
    for (const int answer : protocol.trials.task->answers())
      if (protocol.trials.task->is_right(session.trial(), answer)) return answer;
    return -1;
  }
  int wrong() const {
    for (const int answer : protocol.trials.task->answers())
      if (answer != right()) return answer;
    return -1;
  }
  std::vector<ResponseLine> lines(const std::string& kind) const {
    std::vector<ResponseLine> found;
    for (const ResponseLine& line : file.lines())
      if (line["kind"] == kind) found.push_back(line);
    return found;
  }

  Protocol protocol;
  StudySight sight = test::sight_at(100.0);
  ResponseFile file;
  StudySession session;

 private:
  StudyAct act_for(int number) const { return protocol.trials.task->act_of(number); }
};

TEST(Practice, EndsWhenTheShareOfTheLastAnswersIsReached) {
  Practice practice({.trials = 12, .right = 0.75, .window = 4});
  for (const bool right : {true, true, false, false}) {
    practice.answer(right);
    EXPECT_FALSE(practice.is_done());
  }
  practice.answer(true);
  EXPECT_FALSE(practice.is_done()) << "two of the last four";
  practice.answer(true);
  EXPECT_FALSE(practice.is_done()) << "two of the last four";
  practice.answer(true);
  EXPECT_TRUE(practice.is_done());
  EXPECT_TRUE(practice.passed());
  EXPECT_EQ(practice.share(), 0.75);
}

TEST(Practice, EndsWithoutItsCriterionAfterAllTrials) {
  Practice practice({.trials = 5, .right = 0.8, .window = 5});
  for (int i = 0; i < 5; ++i) practice.answer(i % 2 == 0);
  EXPECT_TRUE(practice.is_done());
  EXPECT_FALSE(practice.passed());
  practice.begin();
  EXPECT_FALSE(practice.is_done());
}

TEST(Practice, HasAFixedNumberOfTrialsWithoutACriterion) {
  Practice practice({.trials = 3, .right = 0.0});
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(practice.is_done());
    practice.answer(false);
  }
  EXPECT_TRUE(practice.is_done());
  EXPECT_TRUE(practice.passed());
}

// Answers of a person who is right with probability p: the practice ends as often within n trials
// as a simulation of its rule in other words.
TEST(Practice, EndsAtTheFirstWindowWithEnoughRightAnswersForRandomAnswers) {
  Random random(7);
  for (int run = 0; run < 20'000; ++run) {
    const PracticeSettings settings{.trials = 1 + random.below(30),
                                    .right = 0.1 * (1 + random.below(10)),
                                    .window = 1 + random.below(8)};
    Practice practice(settings);
    std::vector<int> right;
    bool passed = false;
    while (!practice.is_done()) {
      right.push_back(random.below(3) > 0 ? 1 : 0);
      practice.answer(right.back() == 1);
      int sum = 0;
      const int n = static_cast<int>(right.size());
      for (int i = std::max(0, n - settings.window); i < n; ++i)
        sum += right[static_cast<std::size_t>(i)];
      passed = n >= settings.window && sum >= settings.right * settings.window - 1e-9;
      ASSERT_EQ(practice.is_done(), passed || n == settings.trials);
    }
    ASSERT_EQ(practice.passed(), passed);
  }
}

TEST(ExtraTrials, CheckOncePerStretchAndNeverBeforeTheFirstTrial) {
  const Protocol p =
      test::study_protocol("[trials]\nrepeats = 40\ncatch_every = 8\nattention_every = 5\n");
  for (int participant = 1; participant <= 50; ++participant) {
    ExtraTrials extras(p, participant);
    std::vector<int> before[3];
    for (int done = 0; done < 80; ++done) {
      for (int i = 0; i < 3; ++i) {
        const auto extra = extras.next(static_cast<std::size_t>(done), {.method = 1});
        if (!extra) break;
        ASSERT_NE(extra->kind, ExtraKind::Practice);
        EXPECT_EQ(extra->trial.method, 1);
        before[static_cast<std::size_t>(extra->kind)].push_back(done);
        extras.answer(extra->kind, static_cast<std::size_t>(done), true);
        ASSERT_LT(i, 2) << "no third one";
      }
    }
    for (const auto& [kind, every] : {std::pair{1, 8}, {2, 5}}) {
      const std::vector<int>& given = before[kind];
      ASSERT_EQ(given.size(), 80U / static_cast<unsigned>(every));
      EXPECT_GT(given.front(), 0);
      for (std::size_t i = 0; i < given.size(); ++i)
        EXPECT_EQ(given[i] / every, static_cast<int>(i));
    }
  }
}

TEST(ExtraTrials, PlacesDifferBetweenParticipantsAndAreReproducible) {
  const Protocol p = test::study_protocol("[trials]\nrepeats = 40\ncatch_every = 10\n");
  const auto places = [&](int participant) {
    const ExtraTrials extras(p, participant);
    std::vector<std::size_t> out;
    for (std::size_t done = 0; done < 80; ++done)
      if (extras.next(done, {})) out.push_back(done);
    return out;
  };
  EXPECT_EQ(places(1), places(1));
  EXPECT_NE(places(1), places(2));
}

TEST(ExtraTrials, PracticeLeadsToTheTrialsOnceTheCriterionIsReached) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[practice]\ntrials = 10\nright = 0.75\nwindow = 4\n" + kShort),
            folder.file("1.jsonl"));
  ASSERT_EQ(s.session.phase(), StudyPhase::Ready);
  EXPECT_EQ(s.session.practice_trial(), 1);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(s.present());
    EXPECT_EQ(s.session.practice_trial(), i + 1);
    EXPECT_EQ(s.answer(i < 2 ? s.wrong() : s.right()), "");
    EXPECT_EQ(s.session.feedback(), i >= 2) << "practice gives feedback";
    EXPECT_EQ(s.session.trials_done(), 0U);
    EXPECT_THAT(s.act(Do::Correct), HasSubstr("not possible"));
  }
  EXPECT_EQ(s.session.phase(), StudyPhase::Ready);
  EXPECT_EQ(s.session.practice_trial(), 0);
  EXPECT_EQ(s.session.practice_failed(), "");
  const auto practised = s.lines("practised");
  ASSERT_EQ(practised.size(), 1U);
  EXPECT_EQ(practised[0]["trials"], 5);
  EXPECT_EQ(practised[0]["right"], 0.75);
  EXPECT_EQ(practised[0]["passed"], true);
  ASSERT_EQ(s.lines("practice").size(), 5U);
  EXPECT_EQ(s.lines("practice")[0]["right"], 0);
  EXPECT_EQ(s.lines("practice")[4]["right"], 1);
  ASSERT_TRUE(s.present());
  EXPECT_FALSE(s.session.extra());
  EXPECT_EQ(s.session.trial(), trial_order(s.protocol, 1)[0]);
}

TEST(ExtraTrials, AFailedPracticeIsReportedAndCanBeRepeated) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[practice]\ntrials = 4\nright = 1\nwindow = 2\n" + kShort),
            folder.file("1.jsonl"));
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(s.present());
    s.answer(s.wrong());
  }
  ASSERT_EQ(s.session.phase(), StudyPhase::Ready);
  EXPECT_THAT(s.session.practice_failed(), HasSubstr("0 % of the last 2 answers were right"));
  std::string news;
  ASSERT_TRUE(s.session.next_news(news));
  EXPECT_EQ(news, s.session.practice_failed());
  EXPECT_EQ(s.lines("practised")[0]["passed"], false);
  EXPECT_EQ(s.act(Do::Practise), "");
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(s.present());
    EXPECT_EQ(s.session.practice_trial(), i + 1);
    s.answer(s.right());
  }
  ASSERT_EQ(s.session.phase(), StudyPhase::Ready);
  EXPECT_EQ(s.session.practice_failed(), "");
  EXPECT_THAT(s.act(Do::Practise), HasSubstr("not possible"));
  EXPECT_EQ(s.lines("practised")[1]["passed"], true);
  ASSERT_TRUE(s.present());
  EXPECT_FALSE(s.session.extra());
}

TEST(ExtraTrials, EachMethodIsPractised) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("methods = \"within\"\n[practice]\ntrials = 2\nright = 0\n" +
                                 kShort + "repeats = 1\n"),
            folder.file("1.jsonl"));
  std::vector<std::string> kinds;
  while (s.present()) {
    kinds.emplace_back(s.session.extra() ? "practice" : "trial");
    EXPECT_EQ(s.session.trial().method, s.session.course().trial().method);
    s.answer(1);
  }
  const std::vector<std::string> block = {"practice", "practice", "trial", "trial"};
  std::vector<std::string> both = block;
  both.insert(both.end(), block.begin(), block.end());
  EXPECT_EQ(kinds, both);
  EXPECT_EQ(s.session.phase(), StudyPhase::Done);
}

TEST(ExtraTrials, ACatchTrialIsSilentAndLooksLikeAnyOther) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol(kShort + "repeats = 8\ncatch_every = 4\n"),
            folder.file("1.jsonl"));
  int catches = 0;
  while (s.present()) {
    const bool is_catch = s.session.extra().has_value();
    EXPECT_EQ(s.session.wanted().sound, !is_catch);
    EXPECT_EQ(s.session.presents_nothing(), is_catch);
    EXPECT_GE(s.session.wanted().scene, 0) << "the smoke develops, too";
    EXPECT_FALSE(s.session.question().empty());
    EXPECT_EQ(s.session.practice_trial(), 0);
    const std::size_t done = s.session.trials_done();
    s.answer(is_catch && catches == 0 ? 1 : s.right());
    EXPECT_FALSE(s.session.feedback());
    EXPECT_EQ(s.session.trials_done(), is_catch ? done : done + 1);
    catches += is_catch ? 1 : 0;
  }
  EXPECT_EQ(catches, 4);
  const auto lines = s.lines("catch");
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0]["answer"], 1);
  EXPECT_EQ(lines[0]["right"], 0);
  EXPECT_EQ(lines[1]["right"], 1);
  const auto trials = s.lines("trial");
  ASSERT_EQ(trials.size(), 16U);
  for (const ResponseLine& line : trials) EXPECT_EQ(line["correct"], 1);
}

TEST(ExtraTrials, AnAttentionTrialAsksForAnAnswer) {
  const test::TemporaryFolder folder;
  Sitting s(with_levels("forced-choice", "attention_every = 3\n", "reference = 2\n"),
            folder.file("1.jsonl"));
  int checks = 0;
  for (int i = 0; i < 40 && s.present(); ++i) {
    if (s.session.extra()) {
      ++checks;
      const int wanted = *s.session.extra()->wanted;
      EXPECT_EQ(s.session.question(),
                wanted == 1 ? "This trial checks attention. Please answer: The first."
                            : "This trial checks attention. Please answer: The second.");
      EXPECT_EQ(s.answer(wanted), "");
      EXPECT_EQ(s.lines("attention").back()["right"], 1);
      EXPECT_EQ(s.lines("attention").back()["answer"], wanted);
    } else {
      EXPECT_EQ(s.session.question(), "Stronger?");
      EXPECT_EQ(s.answer(s.session.trial().level_at), "");
    }
  }
  EXPECT_GE(checks, 5);
}

TEST(ExtraTrials, AreTheSameAfterAResume) {
  const std::string text = "[practice]\ntrials = 6\nright = 0.5\nwindow = 2\n" + kShort +
                           "repeats = 6\ncatch_every = 3\nattention_every = 4\nfeedback = true\n";
  const Protocol p = test::study_protocol(text);
  const test::TemporaryFolder folder;
  const auto answers = [&](const std::string& path, bool resumes) {
    std::vector<std::string> given;
    Random random(5);
    bool over = false;
    while (!over) {
      Sitting s(p, path);
      while (!over) {
        if (!s.present()) ADD_FAILURE() << "no trial";
        const auto& extra = s.session.extra();
        given.push_back(fmt::format("{} {} {} {}", extra ? name_of(extra->kind) : "trial",
                                    s.session.trial().scene, s.session.question(),
                                    s.session.trials_done()));
        s.answer(random.below(2));
        over = s.session.phase() == StudyPhase::Done;
        if (resumes) break;
      }
    }
    return given;
  };
  EXPECT_EQ(answers(folder.file("1.jsonl"), false), answers(folder.file("2.jsonl"), true));
}

TEST(ExtraTrials, AnInterruptedOneIsPresentedAgain) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol("[practice]\ntrials = 3\nright = 0\n" + kShort),
            folder.file("1.jsonl"));
  ASSERT_TRUE(s.present());
  const Trial trial = s.session.trial();
  EXPECT_EQ(s.act(Do::Pause), "");
  EXPECT_EQ(s.act(Do::Next), "");
  ASSERT_TRUE(s.present());
  EXPECT_EQ(s.session.trial(), trial);
  EXPECT_TRUE(s.session.extra());
}

TEST(ExtraTrials, AFixedDurationTakesTheAnswerAfterTheStimulus) {
  const test::TemporaryFolder folder;
  Sitting s(test::study_protocol(kShort + "time_limit = 2\nfixed_duration = true\n"),
            folder.file("1.jsonl"));
  s.act(Do::Next);
  while (s.session.phase() != StudyPhase::Presenting) s.pass();
  double sound = 0.0;
  while (s.session.wanted().sound) {
    EXPECT_THAT(s.answer(1), HasSubstr("after the stimulus"));
    sound += 0.1;
    s.pass();
  }
  EXPECT_NEAR(sound, 2.0, 0.11);
  EXPECT_TRUE(s.session.takes_answer());
  s.pass(0.5);
  EXPECT_EQ(s.answer(1), "");
  EXPECT_NEAR(s.lines("trial")[0]["response_s"].get<double>(), sound + 0.5, 0.11);
}

TEST(ExtraTrials, RehearsalsAnswerChecksRightly) {
  for (const char* task : {"judgement", "forced-choice"}) {
    const bool judged = task == std::string("judgement");
    const test::TemporaryFolder folder;
    Sitting s(with_levels(task, judged ? "catch_every = 3\n" : "attention_every = 3\n",
                          judged ? "" : "reference = 2\n"),
              folder.file("1.jsonl"));
    Rehearsal rehearsal(0, 3);
    for (int i = 0; i < 20'000 && !s.session.closed(); ++i) {
      if (const auto act = rehearsal.act(s.session, s.sight.time)) s.session.take(*act, s.sight);
      s.pass();
    }
    EXPECT_TRUE(s.session.closed());
    const auto checks = s.lines(judged ? "catch" : "attention");
    EXPECT_GE(checks.size(), 3U);
    for (const ResponseLine& line : checks) EXPECT_EQ(line["right"], 1);
  }
}

TEST(ExtraTrials, SettingsThatDoNotFitTheTaskAreRefused) {
  const auto refuses = [](const std::function<void()>& read, const std::string& words) {
    EXPECT_THAT(test::input_error(read), HasSubstr(words));
  };
  const auto study = [](const std::string& text) { return [text] { test::study_protocol(text); }; };
  refuses(study("[trials]\ncatch_every = 1\n"), "catch_every is 1");
  refuses(study("[trials]\nattention_every = 1\n"), "attention_every is 1");
  refuses(study("[trials]\nfixed_duration = true\n"), "set trials.time_limit above 0 s");
  refuses(study("[practice]\ntrials = 5\nwindow = 6\n"), "window = 6 must not be above");
  refuses([] { with_levels("forced-choice", "catch_every = 4\n", "reference = 2\n"); },
          "needs a task with the answer no");
  refuses([] { with_levels("judgement", "[practice]\ntrials = 5\nwindow = 2\n"); },
          "practice.right needs right answers");
  for (const char* setting : {"catch_every = 4\n", "attention_every = 4\n",
                              "fixed_duration = true\n", "[practice]\ntrials = 3\n"})
    refuses([&] { with_levels("adjustment", setting, "reference = 3\n"); }, "has no answers");
}

TEST(ExtraTrials, ProtocolsWithoutThemAreWrittenAsBefore) {
  const nlohmann::ordered_json plain = protocol_json(test::study_protocol());
  EXPECT_FALSE(plain.contains("practice"));
  for (const char* key : {"fixed_duration", "catch_every", "attention_every"})
    EXPECT_FALSE(plain["trials"].contains(key)) << key;
  const nlohmann::ordered_json full = protocol_json(
      test::study_protocol("[practice]\ntrials = 12\n[trials]\ncatch_every = 4\n"
                           "attention_every = 5\ntime_limit = 2\nfixed_duration = true\n"));
  EXPECT_EQ(full["practice"]["trials"], 12);
  EXPECT_EQ(full["trials"]["catch_every"], 4);
  EXPECT_EQ(full["trials"]["attention_every"], 5);
  EXPECT_EQ(full["trials"]["fixed_duration"], true);
}

}  // namespace
}  // namespace prostm
