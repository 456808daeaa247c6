#include "prostm/felt/felt_cells.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/target/pressure_share.hpp"

namespace prostm {
namespace {

constexpr double kMm = 1e3;  // per metre

}  // namespace

FeltCells::FeltCells(std::size_t most) : most_(most) {
  cells_.reserve(most);
  blocks_.reserve(kBlocks);
}

/// Sums the skin in blocks of `width` × `width` cells. @return whether the capacity suffices.
bool FeltCells::fill(const TargetField& target, double maximum, int width) {
  rows_ = (target.rows + width - 1) / width;
  cols_ = (target.cols + width - 1) / width;
  pitch_ = kMm * target.cell * width;
  const auto across = static_cast<std::size_t>(cols_);
  const std::size_t count = static_cast<std::size_t>(rows_) * across;
  if (count > kBlocks) return false;
  blocks_.assign(count, {});
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t i = target.index(row, col);
      if (target.skin[i] == 0) continue;
      const double weight = target.weight.empty() ? 1.0 : target.weight[i];
      Cell& block = blocks_[static_cast<std::size_t>(row / width) * across +
                            static_cast<std::size_t>(col / width)];
      block.row = row / width;
      block.col = col / width;
      block.area += weight;
      block.x += weight * kMm * target.cell * col;
      block.y += weight * kMm * target.cell * row;
      block.pressure += weight * pressure_share(target.pressure[i], maximum);
    }
  }
  const auto with_skin = std::count_if(blocks_.begin(), blocks_.end(),
                                       [](const Cell& block) { return block.area > 0.0; });
  return with_skin <= static_cast<std::ptrdiff_t>(most_);
}

void FeltCells::set(const TargetField& target, double maximum) {
  int width = std::max(1, static_cast<int>(kWidth / target.cell + 1e-6));
  while (!fill(target, maximum, width)) ++width;
  double whole = 0.0;
  for (const Cell& block : blocks_) whole += block.area;
  cells_.clear();
  for (Cell& block : blocks_) {
    if (block.area <= 0.0) continue;
    block.x /= block.area;
    block.y /= block.area;
    block.pressure /= block.area;
    block.area /= whole;
    cells_.push_back(block);
  }
}

}  // namespace prostm
