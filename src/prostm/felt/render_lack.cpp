#include "prostm/felt/render_lack.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "prostm/felt/detail/felt_kernels.hpp"

namespace prostm {
namespace {

constexpr double kBlur = 8.5;   // blur of S_8.5 [mm]
constexpr double kReach = 4.0;  // standard deviations, (Q5)
constexpr double kLeastVariance =
    0.05;  // lower bound over the mean square, since a constant target has no variance

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
  for (Vector* v : {&area_, &target_, &blurred_target_, &density_, &smooth_, &pull_})
    v->setZero(most);
  place_.reserve(most_cells);
  // the largest raster, margin included, is that of a single line of blocks
  constexpr auto kMost =
      (Eigen::Index{FeltCells::kBlocks} + 2 * kMostReach) * (2 * kMostReach + 1) +
      Eigen::Index{kFeltMargin};
  for (Vector* v : {&plane_, &down_, &across_}) v->setZero(kMost);
}

template <class Real>
void RenderLack<Real>::set(const FeltCells& cells) {
  cells_ = static_cast<Eigen::Index>(cells.cells().size());
  rows_ = cells.rows();
  cols_ = cells.cols();
  reach_ = std::clamp(static_cast<int>(std::ceil(kReach * kBlur / cells.pitch())), 1, kMostReach);
  stride_ = cols_ + 2 * reach_;
  for (Eigen::Index t = 0; t <= 2 * reach_; ++t) {
    const double away = cells.pitch() / kBlur * static_cast<double>(t - reach_);
    taps_[static_cast<std::size_t>(t)] = static_cast<Real>(std::exp(-0.5 * away * away));
  }
  plane_.head((rows_ + 2 * reach_) * stride_).setZero();
  place_.clear();
  for (const FeltCells::Cell& cell : cells.cells()) {
    const auto i = static_cast<Eigen::Index>(place_.size());
    area_[i] = static_cast<Real>(cell.area);
    target_[i] = static_cast<Real>(cell.pressure);
    place_.push_back((cell.row + reach_) * stride_ + cell.col + reach_);
  }
  blur(area(), density_.head(cells_));
  auto blurred = blurred_target_.head(cells_);
  blur(area().cwiseProduct(target_.head(cells_)), blurred);
  blurred.array() /= density_.head(cells_).array();
  sharp_.set(area(), target_.head(cells_));
  blurred_.set(area(), blurred);
}

/// Convolves with a Gaussian along the columns, then the rows. The operation is symmetric, so its
/// gradient is the same convolution.
template <class Real>
void RenderLack<Real>::blur(const Field& field, Eigen::Ref<Vector> out) {
  for (Eigen::Index i = 0; i < cells_; ++i) plane_[place_[static_cast<std::size_t>(i)]] = field[i];
  const auto stride = static_cast<std::size_t>(stride_), reach = static_cast<std::size_t>(reach_);
  const std::span<const Real> taps = std::span(taps_).first(2 * reach + 1);
  const std::size_t count = static_cast<std::size_t>(rows_) * stride;
  const auto convolve = felt_kernels<Real>().convolve;
  convolve(plane_.data(), stride, taps, count, down_.data());
  convolve(down_.data(), 1, taps, count - 2 * reach, across_.data());
  const Eigen::Index corner = reach_ * (stride_ + 1);
  for (Eigen::Index i = 0; i < cells_; ++i)
    out[i] = across_[place_[static_cast<std::size_t>(i)] - corner];
}

template <class Real>
Real RenderLack<Real>::of(const Eigen::Ref<const Vector>& field, Real fine,
                          Eigen::Ref<Vector> pull) {
  auto smooth = smooth_.head(cells_), own = pull_.head(cells_), density = density_.head(cells_);
  own = area().cwiseProduct(field);
  blur(own, smooth);
  smooth.array() /= density.array();
  coarse_ = blurred_.of(area(), blurred_target_.head(cells_), smooth, own);
  own.array() /= density.array();
  blur(own, pull);
  pull.array() *= area().array();
  if (fine == 0) return coarse_;
  const Real sharp = sharp_.of(area(), target_.head(cells_), field, own);
  pull += fine * own;
  return coarse_ + fine * sharp;
}

template class RenderLack<float>;
template class RenderLack<double>;

}  // namespace prostm
