#pragma once
/// 1 − S of a field against its target, and its gradient.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "prostm/felt/felt_cells.hpp"

namespace prostm {

/// 1 − S_8.5 and 1 − S_0, (Q4) and (Q5), over the cells of a target.
template <class Real>
class RenderLack {
 public:
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  /// Only construction allocates.
  explicit RenderLack(std::size_t most_cells);

  /// Sets the target. @pre some pressure is above 0.
  void set(const FeltCells& cells);
  /// Returns 1 − S_8.5 + fine (1 − S_0). @param pull its gradient with respect to the field. @pre
  /// the field has a value above 0.
  Real of(const Eigen::Ref<const Vector>& field, Real fine, Eigen::Ref<Vector> pull);
  /// Returns 1 − S_8.5 of the field of the last of().
  Real coarse() const { return coarse_; }

  /// Shares of the skin of the cells; their sum is 1.
  Eigen::Ref<const Vector> area() const { return area_.head(cells_); }

 private:
  using Field = Eigen::Ref<const Vector>;
  /// 1 − S against one target.
  struct Measure {
    Real square = 0, variance = 1;
    void set(const Field& area, const Field& target);
    Real of(const Field& area, const Field& target, const Field& field,
            Eigen::Ref<Vector> pull) const;
  };

  void blur(const Field& field, Eigen::Ref<Vector> out);

  static constexpr int kMostReach = 16;  // blocks that the blur reaches
  Eigen::Index cells_ = 0;
  // the first cells_ entries are in use; density_ is the blur of the area
  Vector area_, target_, blurred_target_, density_, smooth_, pull_;
  Measure sharp_, blurred_;
  Real coarse_ = 0;
  // the raster of blocks, with a margin of reach_ without area
  Eigen::Index rows_ = 0, cols_ = 0, reach_ = 0, stride_ = 0;
  std::array<Real, 2 * kMostReach + 1> taps_{};
  std::vector<Eigen::Index> place_;  // index of each cell in the raster
  Vector plane_, down_, across_;     // not blurred; blurred along columns; and along rows
};

}  // namespace prostm
