#include "prostm/score/detail/skin_blur.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/score/detail/bands.hpp"
#include "prostm/score/detail/blur_kernel.hpp"

namespace prostm {
namespace {

constexpr double kBlur = 8.5e-3;    // b of skill_8 [m]
constexpr double kBlurReach = 4.0;  // cut-off of the Gaussian along each axis, in b
constexpr std::size_t kRowsOfBlur = 4 * kStripWidth;  // rows of a band
constexpr std::size_t kTapsBeside = kSumsAtOnce - 1;  // zeros at each end of the kernel

}  // namespace

std::size_t SkinBlur::reach() const {
  return taps_.size() / 2 - kTapsBeside;
}

SkinBlur::SkinBlur(const TargetField& target, WorkerPool* pool)
    : rows_(static_cast<std::size_t>(target.rows)),
      cols_(static_cast<std::size_t>(target.cols)),
      skin_(target.skin.begin(), target.skin.end()),
      pool_(pool) {
  const double reach =
      std::min(kBlurReach * kBlur / target.cell, static_cast<double>(rows_ + cols_));
  const auto cells = static_cast<std::size_t>(reach);
  taps_.resize(2 * (kTapsBeside + cells) + 1);
  for (std::size_t i = 0; i <= cells; ++i) {
    const double d = static_cast<double>(i) * target.cell / kBlur;
    taps_[kTapsBeside + cells - i] = taps_[kTapsBeside + cells + i] = std::exp(-0.5 * d * d);
  }
  sum_ = blur(skin_);
}

std::vector<double> SkinBlur::of(const std::vector<double>& field) const {
  std::vector<double> out = blur(field);
  for_bands(pool_, rows_, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first * cols_; i < end * cols_; ++i)
      out[i] = skin_[i] > 0.0 ? out[i] / sum_[i] : 0.0;
  });
  return out;
}

/// Blurs along columns, then along rows, since the kernel over a square is separable.
std::vector<double> SkinBlur::blur(const std::vector<double>& in) const {
  std::vector<double> out(in.size());
  const auto band = [&](std::size_t first, std::size_t end) {
    const std::vector<double> across = columns(in, first, end);
    std::array<double, kSumsAtOnce * kStripWidth> sums;
    for (std::size_t top = first; top < end; top += kStripWidth) {
      const double* strip = across.data() + (top - first) * cols_;
      for (std::size_t col = 0; col < cols_; col += kSumsAtOnce) {
        sums_about(col, cols_, strip, 0, sums.data());
        for (std::size_t j = 0; j < std::min(kSumsAtOnce, cols_ - col); ++j) {
          for (std::size_t i = 0; i < std::min(kStripWidth, end - top); ++i)
            out[(top + i) * cols_ + col + j] = sums[j * kStripWidth + i];
        }
      }
    }
  };
  for_bands(pool_, rows_, band, kRowsOfBlur);
  return out;
}

/// Blurs the skin of rows from `first` to `end` along columns. The result is in strips of
/// kStripWidth rows; each strip is stored column by column.
std::vector<double> SkinBlur::columns(const std::vector<double>& in, std::size_t first,
                                      std::size_t end) const {
  const std::size_t low = first - std::min(first, reach()), high = std::min(end + reach(), rows_);
  std::vector<double> strip((high - low) * kStripWidth), across(kRowsOfBlur * cols_);
  std::array<double, kSumsAtOnce * kStripWidth> sums;
  for (std::size_t left = 0; left < cols_; left += kStripWidth) {
    const std::size_t width = std::min(kStripWidth, cols_ - left);
    for (std::size_t row = low; row < high; ++row) {
      for (std::size_t i = 0; i < width; ++i) {
        const std::size_t cell = row * cols_ + left + i;
        strip[(row - low) * kStripWidth + i] = skin_[cell] * in[cell];
      }
    }
    for (std::size_t row = first; row < end; row += kSumsAtOnce) {
      sums_about(row, high, strip.data(), low, sums.data());
      for (std::size_t j = 0; j < kSumsAtOnce; ++j) {
        const std::size_t under = row + j - first, top = under - under % kStripWidth;
        for (std::size_t i = 0; i < width; ++i)
          across[top * cols_ + (left + i) * kStripWidth + under % kStripWidth] =
              sums[j * kStripWidth + i];
      }
    }
  }
  return across;
}

/// Computes the sums at positions from `first` on, from a strip that contains positions `low` to
/// `end`.
void SkinBlur::sums_about(std::size_t first, std::size_t end, const double* strip, std::size_t low,
                          double* to) const {
  const std::size_t from = std::max(first - std::min(first, reach()), low),
                    until = std::min(first + kSumsAtOnce + reach(), end);
  strip_sums(taps_.data() + kTapsBeside + reach() + from - first,
             strip + (from - low) * kStripWidth, until - from, to);
}

}  // namespace prostm
