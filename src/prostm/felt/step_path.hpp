#pragma once
/// A closed path with one or more laps per loop, as a set of point sources: equation (W1) of
/// docs/design/planner-felt.md.

#include <array>
#include <cstddef>
#include <span>

#include "prostm/felt/felt_loss.hpp"

namespace prostm {

/// Maximum number of points of a path.
inline constexpr std::size_t kMostStepPoints = 64;

/// One path. The focal point starts at the first point when the loop begins, at constant speed.
template <class Real>
class StepPath {
 public:
  /// Sets the points, in the order in which they are passed [mm]. @param laps laps per loop, ≥ 1.
  /// @pre 3 to kMostStepPoints points, not all equal.
  void set(std::span<const Real> x, std::span<const Real> y, int laps);
  /// Fills one source per point: it represents half of the segment to each of its neighbours.
  /// @param first first harmonic of the model.
  void sources(int first, std::span<FeltSource<Real>> out) const;
  /// Adds the gradient with respect to the points [1/mm] that results from their times and shares.
  /// @param by_time gradient with respect to time(). @param by_share with respect to share().
  void add_gradient(std::span<const Real> by_time, std::span<const Real> by_share,
                    std::span<Real> gradient_x, std::span<Real> gradient_y) const;

  Real length() const { return length_; }  ///< [mm]
  int laps() const { return laps_; }
  /// Twice the share of a lap that a point represents.
  Real share(std::size_t point) const {
    return (segment_[point] + segment_[(point + count_ - 1) % count_]) / length_;
  }
  /// Share of a lap at which a point is passed.
  Real time(std::size_t point) const { return passed_[point] / length_; }

 private:
  std::size_t count_ = 0;
  int laps_ = 1;
  Real length_ = 0;
  // coordinates, length of the segment after each point, path length up to it
  std::array<Real, kMostStepPoints> x_{}, y_{}, segment_{}, passed_{};
};

extern template class StepPath<float>;
extern template class StepPath<double>;

}  // namespace prostm
