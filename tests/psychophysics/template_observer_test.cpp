#include "prostm/psychophysics/template_observer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

Percept random_percept(std::size_t size, Random& random) {
  Percept out(size);
  for (double& v : out) v = random.uniform(0.0, 2.0);
  return out;
}

TEST(Observer, SensitivityMatchesTheFullCovariance) {
  Random random(1);
  for (int draw = 0; draw < 200; ++draw) {
    const auto size = static_cast<std::size_t>(1 + random.below(30));
    const Percept first = random_percept(size, random), second = random_percept(size, random);
    const ObserverNoise noise{random.uniform(0.05, 2.0), random.uniform(0.0, 1.0)};
    const auto n = static_cast<Eigen::Index>(size);
    const Eigen::VectorXd a = Eigen::VectorXd::Map(first.data(), n),
                          b = Eigen::VectorXd::Map(second.data(), n), middle = 0.5 * (a + b);
    const double local = noise.local * middle.maxCoeff();
    const Eigen::MatrixXd covariance = local * local * Eigen::MatrixXd::Identity(n, n) +
                                       noise.common * noise.common * middle * middle.transpose();
    const Eigen::VectorXd weight = covariance.llt().solve(b - a);
    const double d = std::sqrt((b - a).dot(weight));
    const TemplateObserver observer(first, second, noise);
    EXPECT_NEAR(observer.d_prime(), d, 1e-9 * d);
    const Percept other = random_percept(size, random);
    const Eigen::VectorXd x = Eigen::VectorXd::Map(other.data(), n);
    EXPECT_NEAR(observer.evidence(other), weight.dot(x - middle) / d, 1e-8);
  }
}

TEST(Observer, IsRightAsOftenAsItsSensitivityPredicts) {
  const Percept first = {1.0, 0.4, 0.2, 0.7}, second = {0.8, 0.6, 0.2, 0.5};
  const ObserverNoise noise{0.2, 0.3};
  const TemplateObserver observer(first, second, noise);
  EXPECT_NEAR(observer.evidence(first), -0.5 * observer.d_prime(), 1e-12);
  EXPECT_NEAR(observer.evidence(second), 0.5 * observer.d_prime(), 1e-12);
  EXPECT_NEAR(chance_of_right(observer.evidence(second), 0.0), normal_cdf(0.5 * observer.d_prime()),
              1e-12);
  // with noise drawn as in (Y2)
  Random random(2);
  constexpr int kDraws = 40'000;
  int right = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Percept felt = second;
    const double common = noise.common * random.normal();
    for (std::size_t i = 0; i < felt.size(); ++i)
      felt[i] += common * 0.5 * (first[i] + second[i]) + noise.local * 0.9 * random.normal();
    right += observer.evidence(felt) > 0.0 ? 1 : 0;
  }
  const double expected = normal_cdf(0.5 * observer.d_prime());
  EXPECT_NEAR(static_cast<double>(right) / kDraws, expected,
              4.0 * std::sqrt(expected * (1.0 - expected) / kDraws));
}

TEST(Observer, IsAtChanceIfStimuliAreAlike) {
  for (const Percept& same : {Percept{0.3, 0.9}, Percept{0.0, 0.0}}) {
    const TemplateObserver observer(same, same, {0.1, 0.2});
    EXPECT_EQ(observer.d_prime(), 0.0);
    EXPECT_EQ(chance_of_right(observer.evidence({1.0, 5.0}), 0.03), 0.5);
  }
}

TEST(Observer, OneNumberIsJudgedByItsWeberFraction) {
  const TemplateObserver observer({9.0}, {11.0}, {0.2, 0.0});
  EXPECT_NEAR(observer.d_prime(), 1.0, 1e-12);
  EXPECT_NEAR(TemplateObserver({9e-8}, {11e-8}, {0.2, 0.0}).d_prime(), 1.0, 1e-12);
}

TEST(Observer, LapsesAreGuesses) {
  EXPECT_NEAR(chance_of_right(30.0, 0.06), 0.97, 1e-12);
  EXPECT_NEAR(chance_of_right(-30.0, 0.06), 0.03, 1e-12);
}

TEST(Observer, RejectsInvalidTemplates) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const ObserverNoise noise{0.1, 0.0};
  EXPECT_THROW(TemplateObserver({}, {}, noise), std::invalid_argument);
  EXPECT_THROW(TemplateObserver({1.0}, {1.0, 2.0}, noise), std::invalid_argument);
  EXPECT_THROW(TemplateObserver({kInfinity}, {1.0}, noise), std::invalid_argument);
  EXPECT_THROW(TemplateObserver({1.0}, {2.0}, {0.0, 0.2}), std::invalid_argument);
  EXPECT_THROW(TemplateObserver({1.0}, {2.0}, {0.1, -0.2}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
