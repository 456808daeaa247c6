#include "prostm/study/analysis/model_study.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <map>
#include <stdexcept>

namespace prostm {
namespace {

namespace bm = boost::math;

ModelParticipant right_with(double one, double four) {
  return {0.0, {{{one}, {four}}}};
}

TEST(ModelStudy, GuessingIsBinomial) {
  const std::vector<ModelParticipant> pool = {right_with(0.5, 0.5)};
  const auto shares = simulate_shares(pool, {.participants = 8, .trials = 16}, 20'000, 1);
  for (const SimulatedShare& share : shares) EXPECT_EQ(share.mean, 0.5);
  const bm::binomial of_scene(64, 0.5), of_both(128, 0.5);
  EXPECT_NEAR(shares[0].interval.low, bm::quantile(of_scene, 0.025) / 64.0, 1.01 / 64.0);
  EXPECT_NEAR(shares[1].interval.high, bm::quantile(of_scene, 0.975) / 64.0, 1.01 / 64.0);
  EXPECT_NEAR(shares[2].interval.low, bm::quantile(of_both, 0.025) / 128.0, 1.01 / 128.0);
  EXPECT_NEAR(shares[2].interval.high, bm::quantile(of_both, 0.975) / 128.0, 1.01 / 128.0);
}

TEST(ModelStudy, DifferencesBetweenParticipantsWidenTheInterval) {
  const std::vector<ModelParticipant> alike = {right_with(0.7, 0.7)},
                                      apart = {right_with(0.5, 0.5), right_with(0.9, 0.9)};
  const auto width = [](const std::vector<ModelParticipant>& pool) {
    const Interval all = simulate_shares(pool, {}, 5000, 1)[2].interval;
    return all.high - all.low;
  };
  EXPECT_GT(width(apart), 1.5 * width(alike));
}

TEST(ModelStudy, AnswersAreBalancedAndAgreeWithTheirQuestions) {
  Random random(3);
  const std::vector<Answer> answers = simulate_study(
      std::vector{right_with(1.0, 0.0)}, {.participants = 5, .trials = 12}, "am", random);
  ASSERT_EQ(answers.size(), 60U);
  std::map<std::string, int> of_each;
  for (const Answer& a : answers) {
    EXPECT_EQ(a.correct, a.scene == "one-plume");
    EXPECT_EQ(a.correct, (a.question == a.scene) == a.yes);
    EXPECT_TRUE(a.participant.starts_with("model-am-"));
    ++of_each[a.participant + ' ' + a.scene + ' ' + a.question];
  }
  ASSERT_EQ(of_each.size(), 20U);
  for (const auto& [name, count] : of_each) EXPECT_EQ(count, 3) << name;
}

TEST(ModelStudy, AnswersAreReadAsTheyWereWritten) {
  Random random(4);
  const std::vector<ModelParticipant> pool = {right_with(0.8, 0.6)};
  std::vector<Answer> answers = simulate_study(pool, {}, "am", random);
  for (const Answer& a : simulate_study(pool, {}, "pro-stm", random)) answers.push_back(a);
  EXPECT_EQ(answers_from_csv(tidy_csv(answers), "model.csv"), answers);
}

TEST(ModelStudy, LikelihoodIsThatOfParticipantsDrawnFromThePool) {
  const std::vector<ModelParticipant> pool = {right_with(0.5, 0.6), right_with(0.9, 0.7)};
  std::vector<Answer> people;
  const std::map<std::string, std::array<int, 2>> scores = {{"a", {3, 1}}, {"b", {0, 4}}};
  double expected = 0.0;
  for (const auto& [name, right] : scores) {
    double chance = 0.0;
    for (const ModelParticipant& who : pool) {
      chance += 0.5 * bm::pdf(bm::binomial(4, who.right[0][0]), right[0]) *
                bm::pdf(bm::binomial(4, who.right[1][0]), right[1]);
    }
    expected += std::log(chance);
    for (std::size_t s = 0; s < 2; ++s) {
      for (int i = 0; i < 4; ++i) people.push_back({name, "am", kStudyScenes[s], i < right[s]});
    }
  }
  EXPECT_NEAR(log_likelihood(pool, people), expected, 1e-12);
}

/// Moments with a single number, `value` in training and `later` in trials.
std::vector<Percept> moments(double value, double later) {
  std::vector<Percept> out(2 * kTrialMoments, {value});
  for (std::size_t i = 1; i < out.size(); i += 2) out[i] = {later};
  return out;
}

TEST(ModelStudy, AnObserverLearnsInTrainingAndAnswersInTrials) {
  const ObserverNoise noise{0.2, 0.0};
  const ModelParticipant same = observe({moments(9.0, 9.0), moments(11.0, 11.0)}, noise, 0.0);
  EXPECT_NEAR(same.d_prime, 1.0, 1e-12);
  const double half = 0.5 * std::erfc(-0.5 / std::sqrt(2.0));
  ASSERT_EQ(same.right[0].size(), 1U);
  EXPECT_NEAR(same.right[0][0], half, 1e-12);
  EXPECT_NEAR(same.right[1][0], half, 1e-12);
  // the trials' values change the answers, but not what was learned
  const ModelParticipant swapped = observe({moments(9.0, 11.0), moments(11.0, 9.0)}, noise, 0.0);
  EXPECT_EQ(swapped.d_prime, same.d_prime);
  EXPECT_NEAR(swapped.right[0][0], 1.0 - half, 1e-12);
  EXPECT_THROW(observe({std::vector<Percept>(5, {1.0}), moments(1.0, 1.0)}, noise, 0.0),
               std::invalid_argument);
}

TEST(ModelStudy, ShapesAreChecked) {
  EXPECT_NO_THROW(validate(StudyShape{}));
  EXPECT_THROW(validate({.participants = 1}), std::invalid_argument);
  EXPECT_THROW(validate({.trials = 15}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
