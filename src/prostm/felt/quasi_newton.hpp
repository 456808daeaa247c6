#pragma once
/// L-BFGS [P-5] for a few hundred variables.

#include <Eigen/Core>
#include <functional>
#include <span>

#include "prostm/core/lbfgs_memory.hpp"

namespace prostm {

/// Sized once; nothing else allocates.
class QuasiNewton {
 public:
  /// Returns the cost at x, and writes its gradient.
  using Cost = std::function<float(std::span<const float> x, std::span<float> gradient)>;

  explicit QuasiNewton(std::size_t most_variables);

  /// Begins at x. @return the cost there.
  float begin(const Cost& cost, std::span<const float> x);
  /// Lowers the cost from there on, and sets x to the lowest place found.
  /// @param first_step length of the first step [unit of x]. @param evaluations at most, with that
  /// of begin(), ≥ 1. @return the number of evaluations.
  int run(const Cost& cost, float first_step, int evaluations, std::span<float> x);

  float lowest() const { return value_; }  ///< cost at the place found

 private:
  static constexpr std::size_t kMemory = 6;
  using Vector = Eigen::VectorXf;
  struct Operations;
  void find_direction();
  auto head(Vector& v) { return v.head(variables_); }
  float evaluate(const Cost& cost, Vector& x, Vector& gradient);
  bool advance(const Cost& cost, float share, int evaluations, int& used);

  // of the first variables_ entries
  Eigen::Index variables_ = 0;
  LbfgsMemory<Vector, kMemory> memory_;
  Vector x_, gradient_, trial_, trial_gradient_, direction_;
  float value_ = 0.0F;
};

}  // namespace prostm
