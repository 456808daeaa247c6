#include "prostm/score/detail/skin_blur.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace prostm {
namespace {

constexpr double kBlur = 8.5e-3;    // b of skill_8 [m]
constexpr double kBlurReach = 4.0;  // cut-off of the Gaussian along each axis, in b

}  // namespace

SkinBlur::SkinBlur(const TargetField& target)
    : rows_(static_cast<std::size_t>(target.rows)),
      cols_(static_cast<std::size_t>(target.cols)),
      skin_(target.skin.begin(), target.skin.end()) {
  const double reach =
      std::min(kBlurReach * kBlur / target.cell, static_cast<double>(rows_ + cols_));
  kernel_.resize(static_cast<std::size_t>(reach) + 1);
  for (std::size_t i = 0; i < kernel_.size(); ++i) {
    const double d = static_cast<double>(i) * target.cell / kBlur;
    kernel_[i] = std::exp(-0.5 * d * d);
  }
  sum_ = blur(skin_);
}

std::vector<double> SkinBlur::of(const std::vector<double>& field) const {
  std::vector<double> masked(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) masked[i] = skin_[i] * field[i];
  std::vector<double> out = blur(masked);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = skin_[i] > 0.0 ? out[i] / sum_[i] : 0.0;
  return out;
}

/// Blurs along rows, then along columns, since the kernel over a square is separable. Both passes
/// add whole stretches of rows, which vectorises; columns cost no more than rows.
std::vector<double> SkinBlur::blur(const std::vector<double>& in) const {
  std::vector<double> along(in.size(), 0.0), out(in.size(), 0.0);
  const auto reach = static_cast<std::ptrdiff_t>(kernel_.size()) - 1;
  const auto rows = static_cast<std::ptrdiff_t>(rows_), cols = static_cast<std::ptrdiff_t>(cols_);
  const auto add = [](double weight, const double* from, std::ptrdiff_t count, double* to) {
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] += weight * from[i];
  };
  const auto weight = [&](std::ptrdiff_t d) {
    return kernel_[static_cast<std::size_t>(std::abs(d))];
  };
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    const std::ptrdiff_t start = row * cols;
    for (std::ptrdiff_t d = std::max(-reach, 1 - cols); d <= std::min(reach, cols - 1); ++d) {
      add(weight(d), in.data() + start + std::max<std::ptrdiff_t>(d, 0), cols - std::abs(d),
          along.data() + start + std::max<std::ptrdiff_t>(-d, 0));
    }
  }
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    for (std::ptrdiff_t d = std::max(-reach, -row); d <= std::min(reach, rows - 1 - row); ++d)
      add(weight(d), along.data() + (row + d) * cols, cols, out.data() + row * cols);
  }
  return out;
}

}  // namespace prostm
