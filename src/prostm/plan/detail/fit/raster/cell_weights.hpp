#pragma once
/// Weight of each cell's error when a plan is fitted to a target, (P17).

#include <cstddef>

#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// A target's weights over their pressure-weighted mean, Σ w p* / Σ p*. So a common factor of the
/// weights has no effect, and if all pressure has the same weight, the fit is that without weights.
/// Weights below kLeastShare of the largest count as 0. Keeps a reference to the target.
class CellWeights {
 public:
  static constexpr double kLeastShare = 1e-6;

  /// @param maximum the target's largest pressure. @pre maximum > 0; the target has weights, at
  /// least one of them > 0 on skin.
  CellWeights(const TargetField& target, double maximum);

  /// Weight of cell i over the mean, at most 1/kLeastShare; exactly 1 where all weights are 1.
  double operator[](std::size_t i) const { return share(i) / mean_; }
  /// Returns whether the weighted pressure is more than kLeastShare of its value if all weights
  /// were the largest.
  bool any_pressure() const { return any_pressure_; }

 private:
  double share(std::size_t i) const {
    const double of_largest = target_->weight[i] / largest_;
    return of_largest < kLeastShare ? 0.0 : of_largest;
  }

  const TargetField* target_;
  double largest_, mean_ = 1.0;
  bool any_pressure_ = false;
};

}  // namespace prostm::planning
