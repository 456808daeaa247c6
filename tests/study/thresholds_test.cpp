#include "prostm/study/analysis/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/study/analysis/analysis.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Adds answers of an observer at levels 0.1, 0.2, … 0.9 in turn.
void add(std::vector<Answer>& out, const std::string& who, const std::string& method,
         const std::string& scene, const Psychometric& observer, int answers, Random& random) {
  for (int i = 0; i < answers; ++i) {
    const double level = 0.1 * (1 + i % 9);
    out.push_back({.participant = who,
                   .method = method,
                   .scene = scene,
                   .correct = random.uniform() < observer.at(level),
                   .level = level});
  }
}

/// Two methods with known thresholds, in two scenes, with four participants each.
std::vector<Answer> known_answers(const std::array<double, 2>& thresholds, double slope,
                                  int answers) {
  std::vector<Answer> out;
  Random random(5);
  for (int person = 0; person < 8; ++person) {
    const std::size_t method = person % 2 == 0 ? 0 : 1;
    const Psychometric observer{thresholds[method], slope, 0.5, 0.02};
    for (const char* scene : {"x", "y"}) {
      add(out, "P" + std::to_string(person), method == 0 ? "am" : "pro-stm", scene, observer,
          answers, random);
    }
  }
  return out;
}

TEST(Thresholds, OfKnownObserversAreFound) {
  const test::WithoutTraps in_boost;
  const std::array<double, 2> truth = {0.35, 0.55};
  const std::vector<Answer> answers = known_answers(truth, 14.0, 900);
  const auto results = fit_thresholds(answers, {});
  ASSERT_EQ(results.size(), 2U * 2U * 5U);  // scenes, methods, pooled and each of four
  for (std::size_t i = 0; i < results.size(); ++i) {
    const ThresholdResult& of = results[i];
    EXPECT_EQ(of.scene, i < 10 ? "x" : "y");
    EXPECT_EQ(of.method, i / 5 % 2 == 0 ? "am" : "pro-stm");
    EXPECT_EQ(of.participant.empty(), i % 5 == 0);
    ASSERT_TRUE(of.fit && of.fit->threshold) << i;
    // standard errors: 0.007 pooled, 0.014 for one
    EXPECT_NEAR(of.fit->function.threshold, truth[i / 5 % 2], of.participant.empty() ? 0.02 : 0.05);
    EXPECT_EQ(of.scores.size(), 9U);
    int trials = 0;
    for (const LevelScore& score : of.scores) trials += score.correct.trials;
    EXPECT_EQ(trials, of.participant.empty() ? 3600 : 900);
  }
}

// The order of answers does not matter, and the fit is that of the pooled levels.
TEST(Thresholds, PoolAnswersAtTheSameLevel) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers = known_answers({0.4, 0.4}, 10.0, 90);
  const auto results = fit_thresholds(answers, {});
  std::vector<LevelScore> pooled;
  for (int i = 1; i <= 9; ++i) pooled.push_back({0.1 * i, {0, 0}});
  for (const Answer& a : answers) {
    if (a.method != "am" || a.scene != "x") continue;
    Proportion& score = pooled[static_cast<std::size_t>(std::lround(10.0 * *a.level)) - 1].correct;
    ++score.trials;
    score.successes += a.correct ? 1 : 0;
  }
  const auto expected = fit_psychometric(pooled, {}).fit;
  ASSERT_TRUE(expected && results[0].fit);
  EXPECT_EQ(results[0].fit->function.threshold, expected->function.threshold);
  EXPECT_EQ(results[0].fit->threshold->low, expected->threshold->low);
  std::stable_sort(answers.begin(), answers.end(),
                   [](const Answer& a, const Answer& b) { return *a.level > *b.level; });
  const auto sorted = fit_thresholds(answers, {});
  EXPECT_EQ(sorted[0].fit->function.threshold, expected->function.threshold);
}

TEST(Thresholds, AreDescribedInWords) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers = known_answers({0.35, 0.55}, 14.0, 180);
  const Analysis analysis = analyse(answers);
  EXPECT_EQ(analysis.settings.guess, 0.5);
  EXPECT_EQ(analysis.settings.lapse, 0.02);
  const std::string words = in_words(analysis);
  EXPECT_THAT(words, HasSubstr("compare methods only if all were presented at the same levels"));
  EXPECT_THAT(words, HasSubstr("With am in x, the threshold is 0.3"));
  EXPECT_THAT(words, HasSubstr("With pro-stm in y, the threshold is 0.5"));
  EXPECT_THAT(words, HasSubstr("4 of 4 participants have a fit of their own"));
  EXPECT_THAT(words, HasSubstr("between guessing (50 %) and the maximum (98 %)"));
  for (Answer& a : answers) a.correct = *a.level > 0.45;
  const std::string steps = in_words(analyse(answers));
  EXPECT_THAT(steps,
              HasSubstr("a step fits as well as any slope, so the answers bound the "
                        "threshold but not the slope: it is best from 0.4 to 0.5 (95 % interval"));
  EXPECT_THAT(steps, HasSubstr("0 of 4 participants have a fit of their own, 4 only bounds."));
  for (Answer& a : answers) a.level = 0.5;
  EXPECT_THAT(in_words(analyse(answers)), HasSubstr("all answers are at one level"));
  for (Answer& a : answers) a.level.reset();
  EXPECT_THAT(in_words(analyse(answers)), Not(HasSubstr("threshold")));
}

TEST(Thresholds, ArePrintedWithEnoughDigitsToDistinguishThem) {
  const auto digits = [](double low, double high) {
    return level_digits(std::vector<LevelScore>{{low, {1, 2}}, {high, {1, 2}}});
  };
  EXPECT_EQ(digits(0.1, 0.8), 4);
  EXPECT_EQ(digits(-3e8, 1e9), 4);
  EXPECT_EQ(digits(100000.1, 100000.5), 9);
  EXPECT_EQ(digits(1.0, std::nextafter(1.0, 2.0)), 15);
  EXPECT_EQ(digits(0.5, 0.5), 4);
}

TEST(Thresholds, AccountForGuessesAndLapses) {
  const test::WithoutTraps in_boost;
  const std::vector<Answer> answers = known_answers({0.35, 0.55}, 14.0, 90);
  AnalysisSettings settings;
  settings.chance = 0.4;
  EXPECT_EQ(analyse(answers, settings).thresholds[0].fit->function.guess, 0.4);
  settings.guess = 0.25;
  settings.lapse = 0.1;
  const Psychometric psi = analyse(answers, settings).thresholds[0].fit->function;
  EXPECT_EQ(psi.guess, 0.25);
  EXPECT_EQ(psi.lapse, 0.1);
}

// A participant who always says yes: no answer is right or wrong, and the threshold is below.
TEST(Thresholds, AreBelowTheLevelsIfAllAnswersAreForTheLevel) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  for (int i = 0; i < 36; ++i) {
    answers.push_back({.participant = "1",
                       .method = "am",
                       .scene = "x",
                       .correct = true,
                       .level = i < 6 ? 1.6 - 0.1 * i : 1.0,
                       .kind = AnswerKind::Felt});
  }
  const std::string words = in_words(analyse(answers));
  EXPECT_THAT(words,
              HasSubstr("answers for the level are already at their maximum at the lowest level"));
  EXPECT_THAT(words, HasSubstr("it is below 1 (95 % interval of the likelihood over all slopes: "
                               "below 1"));
  EXPECT_THAT(words, Not(HasSubstr("right answers")));
  for (Answer& a : answers) a.correct = *a.level < 1.3;
  EXPECT_THAT(in_words(analyse(answers)), HasSubstr("answers for the level fall with the level"));
}

TEST(Thresholds, LapsesAreFittedOnRequest) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  Random random(9);
  for (const char* who : {"a", "b"})
    add(answers, who, "am", "x", {0.4, 25.0, 0.5, 0.12}, 1800, random);
  EXPECT_THAT(in_words(analyse(answers)), HasSubstr("(--fit-lapse)"));
  AnalysisSettings settings;
  settings.fit_lapse = true;
  const Analysis analysis = analyse(answers, settings);
  EXPECT_NEAR(analysis.thresholds[0].fit->function.lapse, 0.12, 0.02);
  EXPECT_NEAR(analysis.thresholds[0].fit->function.threshold, 0.4, 0.02);
  EXPECT_THAT(in_words(analysis), Not(HasSubstr("does not fit the answers")));
  EXPECT_THAT(in_words(analysis), HasSubstr("1 minus the lapse rate, which is fitted"));
  settings.lapse = 0.1;
  EXPECT_THAT(test::input_error([&] { analyse(answers, settings); }), HasSubstr("leave one"));
}

TEST(Thresholds, RequireLevelsForAllAnswers) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers = known_answers({0.35, 0.55}, 14.0, 18);
  AnalysisSettings settings;
  settings.lapse = 0.7;
  EXPECT_THROW(analyse(answers, settings), std::invalid_argument);
  settings.lapse = 0.4;
  settings.guess = 0.8;
  EXPECT_THROW(analyse(answers, settings), std::invalid_argument);
  answers[3].level.reset();
  EXPECT_THAT(test::input_error([&] { analyse(answers); }), HasSubstr("all must have one"));
  for (Answer& a : answers) a.level.reset();
  EXPECT_THAT(test::input_error([&] { analyse(answers, settings); }), HasSubstr("no level"));
}

}  // namespace
}  // namespace prostm
