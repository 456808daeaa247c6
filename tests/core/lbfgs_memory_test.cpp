#include "prostm/core/lbfgs_memory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

constexpr int kVariables = 7;
constexpr std::size_t kSteps = 3;
using Vector = Eigen::Matrix<float, kVariables, 1>;

struct Operations {
  Vector inverse_diagonal;

  float dot(const Vector& a, const Vector& b) const { return a.dot(b); }
  void add(Vector& v, float factor, const Vector& w) const { v += factor * w; }
  void scale(Vector& v, float factor) const { v *= factor; }
  void precondition(Vector& v) const { v = v.cwiseProduct(inverse_diagonal); }
};

Vector random_vector(Random& random, float least, float most) {
  Vector v;
  for (float& x : v) x = least + (most - least) * static_cast<float>(random.uniform());
  return v;
}

/// A step and the resulting change of the gradient, on a convex quadratic form.
struct Pair {
  Vector step, change;
};

/// −H g, with H from the BFGS updates over the pairs, oldest first [Nocedal & Wright, 7.16].
Eigen::VectorXd dense_direction(const std::vector<Pair>& pairs, const Operations& operations,
                                const Vector& gradient) {
  const Pair& last = pairs.back();
  const Eigen::VectorXd y = last.change.cast<double>();
  const Eigen::MatrixXd diagonal = operations.inverse_diagonal.cast<double>().asDiagonal();
  Eigen::MatrixXd h = last.step.cast<double>().dot(y) / y.dot(diagonal * y) * diagonal;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(kVariables, kVariables);
  for (const Pair& pair : pairs) {
    const Eigen::VectorXd s = pair.step.cast<double>(), c = pair.change.cast<double>();
    const double rho = 1.0 / s.dot(c);
    h = (one - rho * s * c.transpose()) * h * (one - rho * c * s.transpose()) +
        rho * s * s.transpose();
  }
  return -h * gradient.cast<double>();
}

void keep(LbfgsMemory<Vector, kSteps>& memory, const Operations& operations, const Pair& pair) {
  memory.step() = pair.step;
  memory.change() = pair.change;
  Vector scaled = pair.change;
  operations.precondition(scaled);
  const float curvature = operations.dot(pair.step, pair.change);
  memory.keep(curvature, curvature / operations.dot(pair.change, scaled));
}

TEST(LbfgsMemory, GivesTheDirectionOfDenseUpdates) {
  Random random(1);
  for (int trial = 0; trial < 20'000; ++trial) {
    const Operations operations{random_vector(random, 0.5F, 2.0F)};
    const Vector curvature = random_vector(random, 0.2F, 3.0F);
    const Vector gradient = random_vector(random, -1.0F, 1.0F);
    LbfgsMemory<Vector, kSteps> memory;
    std::vector<Pair> pairs;
    const auto kept = static_cast<std::size_t>(1 + trial % 6);  // at times more than fit
    for (std::size_t i = 0; i < kept; ++i) {
      const Vector step = random_vector(random, -1.0F, 1.0F);
      pairs.push_back({step, curvature.cwiseProduct(step)});
      keep(memory, operations, pairs.back());
    }
    if (pairs.size() > kSteps) pairs.erase(pairs.begin(), pairs.end() - kSteps);
    Vector direction = -gradient;
    memory.find_direction(operations, direction);
    const Eigen::VectorXd expected = dense_direction(pairs, operations, gradient);
    ASSERT_LE((direction.cast<double>() - expected).norm(), 2e-6 * (1.0 + expected.norm()));
    ASSERT_LT(direction.dot(gradient), 0.0F);
  }
}

TEST(LbfgsMemory, EqualsThePreconditionerBeforeTheFirstStepAndAfterForgetting) {
  Random random(2);
  const Operations operations{random_vector(random, 0.5F, 2.0F)};
  const Vector gradient = random_vector(random, -1.0F, 1.0F);
  LbfgsMemory<Vector, kSteps> memory;
  for (int round = 0; round < 2; ++round) {
    EXPECT_TRUE(memory.is_empty());
    Vector direction = -gradient;
    memory.find_direction(operations, direction);
    EXPECT_EQ(direction, Vector(-gradient.cwiseProduct(operations.inverse_diagonal)));
    const Vector step = random_vector(random, 0.1F, 1.0F);
    keep(memory, operations, {step, step});
    EXPECT_FALSE(memory.is_empty());
    memory.forget();
  }
}

}  // namespace
}  // namespace prostm
