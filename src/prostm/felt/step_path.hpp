#pragma once
/// A closed path that its focal point goes round once or a few times in a loop, as places where
/// pressure acts: equation (W1) of docs/design/planner-felt.md.

#include <array>
#include <cstddef>
#include <span>

#include "prostm/felt/felt_loss.hpp"

namespace prostm {

/// Most points of a path.
inline constexpr std::size_t kMostStepPoints = 64;

/// One path. The focal point leaves the first point when the loop begins, and moves at one speed.
template <class Real>
class StepPath {
 public:
  /// Takes over the points, in the order in which they are passed [mm]. @param laps in a loop, ≥ 1.
  /// @pre 3 to kMostStepPoints points, not all at one place.
  void set(std::span<const Real> x, std::span<const Real> y, int laps);
  /// Fills a source for each point: it stands for half of the way to each of its neighbours.
  /// @param first first harmonic that is felt.
  void sources(int first, std::span<FeltSource<Real>> out) const;
  /// Adds the gradient with respect to the points, [1/mm], that comes from when they are passed and
  /// how much each stands for. @param by_time with respect to time(), `by_share` to share().
  void add_gradient(std::span<const Real> by_time, std::span<const Real> by_share,
                    std::span<Real> gradient_x, std::span<Real> gradient_y) const;

  Real length() const { return length_; }  ///< [mm]
  int laps() const { return laps_; }
  /// Share of a lap that a point stands for, twice.
  Real share(std::size_t point) const {
    return (segment_[point] + segment_[(point + count_ - 1) % count_]) / length_;
  }
  /// Share of a lap at which a point is passed.
  Real time(std::size_t point) const { return passed_[point] / length_; }

 private:
  std::size_t count_ = 0;
  int laps_ = 1;
  Real length_ = 0;
  // coordinates, length of the segment after each point, length before it
  std::array<Real, kMostStepPoints> x_{}, y_{}, segment_{}, passed_{};
};

extern template class StepPath<float>;
extern template class StepPath<double>;

}  // namespace prostm
