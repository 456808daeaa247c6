#pragma once
/// L-BFGS [P-5] for a few hundred variables.

#include <Eigen/Core>
#include <functional>
#include <span>

#include "prostm/core/lbfgs_memory.hpp"

namespace prostm {

/// The minimiser. Only construction allocates.
class QuasiNewton {
 public:
  /// Returns the cost at x, and writes its gradient.
  using Cost = std::function<float(std::span<const float> x, std::span<float> gradient)>;

  explicit QuasiNewton(std::size_t most_variables);

  /// Begins at x. @return the cost there.
  float begin(const Cost& cost, std::span<const float> x);
  /// Lowers the cost from there, and sets x to the point of lowest cost found.
  /// @param first_step length of the first step [unit of x]. @param evaluations maximum number,
  /// including that of begin(), ≥ 1. @return the number of evaluations.
  int run(const Cost& cost, float first_step, int evaluations, std::span<float> x);

  float lowest() const { return value_; }  ///< cost at the point found

 private:
  static constexpr std::size_t kMemory = 6;
  using Vector = Eigen::VectorXf;
  struct Operations;
  void find_direction();
  auto head(Vector& v) { return v.head(variables_); }
  float evaluate(const Cost& cost, Vector& x, Vector& gradient);
  bool advance(const Cost& cost, float share, int evaluations, int& used);

  // vectors use their first variables_ entries
  Eigen::Index variables_ = 0;
  LbfgsMemory<Vector, kMemory> memory_;
  Vector x_, gradient_, trial_, trial_gradient_, direction_;
  float value_ = 0.0F;
};

}  // namespace prostm
