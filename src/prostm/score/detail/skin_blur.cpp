#include "prostm/score/detail/skin_blur.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "prostm/score/detail/bands.hpp"
#include "prostm/score/detail/blur_kernel.hpp"

namespace prostm {
namespace {

constexpr double kBlur = 8.5e-3;    // b of skill_8 [m]
constexpr double kBlurReach = 4.0;  // cut-off of the Gaussian along each axis, in b

}  // namespace

SkinBlur::SkinBlur(const TargetField& target, WorkerPool* pool)
    : rows_(static_cast<std::size_t>(target.rows)),
      cols_(static_cast<std::size_t>(target.cols)),
      skin_(target.skin.begin(), target.skin.end()),
      pool_(pool) {
  const double reach =
      std::min(kBlurReach * kBlur / target.cell, static_cast<double>(rows_ + cols_));
  const auto cells = static_cast<std::size_t>(reach);
  taps_.resize(2 * cells + 1);
  for (std::size_t i = 0; i <= cells; ++i) {
    const double d = static_cast<double>(i) * target.cell / kBlur;
    taps_[cells - i] = taps_[cells + i] = std::exp(-0.5 * d * d);
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

/// Blurs along rows, then along columns, since the kernel over a square is separable. Columns are
/// taken in strips narrow enough for all rows within reach to stay in the cache.
std::vector<double> SkinBlur::blur(const std::vector<double>& in) const {
  constexpr std::size_t kStrip = 64;  // columns
  const std::size_t reach = taps_.size() / 2;
  std::vector<double> along(in.size()), out(in.size());
  for_bands(pool_, rows_, [&](std::size_t first, std::size_t end) {
    std::vector<double> line(cols_ + 2 * reach, 0.0);  // nothing beyond both ends of a row
    for (std::size_t row = first; row < end; ++row) {
      std::copy_n(in.data() + row * cols_, cols_, line.data() + reach);
      weighted_sums(taps_, line.data(), 1, cols_, along.data() + row * cols_);
    }
  });
  for_bands(pool_, rows_, [&](std::size_t first, std::size_t end) {
    for (std::size_t col = 0; col < cols_; col += kStrip) {
      for (std::size_t row = first; row < end; ++row) {
        const std::size_t low = row - std::min(row, reach), high = std::min(row + reach + 1, rows_);
        weighted_sums(std::span(taps_).subspan(low + reach - row, high - low),
                      along.data() + low * cols_ + col, cols_, std::min(kStrip, cols_ - col),
                      out.data() + row * cols_ + col);
      }
    }
  });
  return out;
}

}  // namespace prostm
