#include "prostm/felt/render_lack.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr double kBlur = 8.5;  // of S_8.5 [mm]
constexpr float kLeastExponent = -60.0F;
constexpr double kLeastVariance = 0.05;  // over the mean square: an even target has none

}  // namespace

template <class Real>
void RenderLack<Real>::Measure::set(const Field& area, const Field& target) {
  square = (area.array() * target.array().square()).sum();
  const Real mean = area.dot(target);
  variance = std::max(square - mean * mean, static_cast<Real>(kLeastVariance) * square);
}

template <class Real>
Real RenderLack<Real>::Measure::of(const Field& area, const Field& target, const Field& field,
                                   Eigen::Ref<Vector> pull) const {
  const Real both = (area.array() * target.array() * field.array()).sum();
  const Real own = (area.array() * field.array().square()).sum();
  const Real gain = both / own;
  pull.array() = (2 * gain / variance) * area.array() * (gain * field.array() - target.array());
  return (square - gain * both) / variance;
}

template <class Real>
RenderLack<Real>::RenderLack(std::size_t most_cells) {
  const auto most = static_cast<Eigen::Index>(most_cells);
  for (Vector* v : {&area_, &target_, &blurred_target_, &smooth_, &pull_}) v->setZero(most);
  blur_.setZero(most, most);
}

template <class Real>
void RenderLack<Real>::set(const std::vector<FeltCells::Cell>& cells) {
  cells_ = static_cast<Eigen::Index>(cells.size());
  auto x = smooth_.head(cells_), y = pull_.head(cells_);  // in units of the blur
  for (Eigen::Index i = 0; i < cells_; ++i) {
    const FeltCells::Cell& cell = cells[static_cast<std::size_t>(i)];
    area_[i] = static_cast<Real>(cell.area);
    target_[i] = static_cast<Real>(cell.pressure);
    x[i] = static_cast<Real>(cell.x / kBlur);
    y[i] = static_cast<Real>(cell.y / kBlur);
  }
  // column by column, then rows are brought to a sum of 1
  auto blur = blur_.topLeftCorner(cells_, cells_);
  for (Eigen::Index j = 0; j < cells_; ++j) {
    blur.col(j) =
        area_[j] * (Real(-0.5) * ((x.array() - x[j]).square() + (y.array() - y[j]).square()))
                       .max(Real(kLeastExponent))
                       .exp()
                       .matrix();
  }
  auto sum = blurred_target_.head(cells_);
  sum.noalias() = blur.rowwise().sum();
  for (Eigen::Index j = 0; j < cells_; ++j) blur.col(j).array() /= sum.array();
  blurred_target_.head(cells_).noalias() =
      blur_.topLeftCorner(cells_, cells_) * target_.head(cells_);
  sharp_.set(area(), target_.head(cells_));
  blurred_.set(area(), blurred_target_.head(cells_));
}

template <class Real>
Real RenderLack<Real>::of(const Eigen::Ref<const Vector>& field, Real fine,
                          Eigen::Ref<Vector> pull) {
  const auto blur = blur_.topLeftCorner(cells_, cells_);
  auto smooth = smooth_.head(cells_), own = pull_.head(cells_);
  smooth.noalias() = blur * field;
  const Real blurred = blurred_.of(area(), blurred_target_.head(cells_), smooth, own);
  pull.noalias() = blur.transpose() * own;
  if (fine == 0) return blurred;
  const Real sharp = sharp_.of(area(), target_.head(cells_), field, own);
  pull += fine * own;
  return blurred + fine * sharp;
}

template class RenderLack<float>;
template class RenderLack<double>;

}  // namespace prostm
