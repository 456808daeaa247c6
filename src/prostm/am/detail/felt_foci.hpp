#pragma once
/// Pressures and phases of AM's foci whose percept resembles the target, (B8) and (B9).

#include <array>
#include <span>
#include <vector>

#include "prostm/am/am_planner.hpp"
#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/felt_tables.hpp"
#include "prostm/felt/quasi_newton.hpp"

namespace prostm {

/// Optimises the percept of AM's foci. Only construction allocates.
class FeltFoci {
 public:
  explicit FeltFoci(const AmSettings& settings);

  /// Replaces the foci's pressures and phases, starting from the given pressures. @param maximum
  /// the target's largest pressure, > 0. @pre some focus has pressure. @return evaluations used.
  int choose(const TargetField& target, double maximum, FocalPoints& foci);

 private:
  static constexpr std::size_t kMost = kMaxPaths;
  /// Two components per focus, a quarter of a period apart: signed amplitudes, whose sum is the
  /// modulation of the focus.
  using Parts = std::array<float, 2 * kMost>;

  void set_foci(const TargetField& target, const FocalPoints& foci);
  float pressure(std::span<const float> parts, std::size_t focus) const;
  float normalise(std::span<const float> parts);
  float cost(std::span<const float> parts, std::span<float> gradient);
  float add_field(std::span<float> by_pressure);

  const AmSettings settings_;
  FeltTables tables_;
  FeltCells cells_;
  FeltLoss<float> loss_;
  QuasiNewton descent_;
  std::size_t foci_ = 0;
  std::vector<std::size_t> nearest_;  // focus of each cell, (B2) …
  std::vector<float> reach_;          // … and its φ there
  Eigen::VectorXf field_, pull_;
  std::vector<FeltSource<float>> sources_;
  Parts at_{}, by_part_{}, unit_{};  // variables; gradient; parts over the output
  std::array<float, 16> by_moment_{};
};

}  // namespace prostm
