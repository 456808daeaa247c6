#include "prostm/plan/focus_widths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace prostm {
namespace {

/// A position between entries `low` and `low + 1`, with weight `share` of the latter.
struct Between {
  std::size_t low = 0;
  double share = 0.0;
};

Between find(const std::vector<double>& list, double value) {
  if (list.size() < 2 || value <= list.front()) return {};
  const auto above = std::upper_bound(list.begin(), list.end() - 1, value);
  const auto low = static_cast<std::size_t>(above - list.begin()) - 1;
  return {low, std::min((value - list[low]) / (list[low + 1] - list[low]), 1.0)};
}

bool ascends(const std::vector<double>& list) {
  bool good = !list.empty();
  for (std::size_t i = 0; i < list.size(); ++i) {
    good = good && std::isfinite(list[i]) && (i == 0 || list[i] > list[i - 1]);
  }
  return good;
}

}  // namespace

double FocusWidths::at(double place_height, double place_offset, double place_tilt) const noexcept {
  const std::array<Between, 3> where = {find(height, place_height), find(offset, place_offset),
                                        find(tilt, place_tilt)};
  const std::array<std::size_t, 3> count = {height.size(), offset.size(), tilt.size()};
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::size_t index = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis & 1U) != 0;
      weight *= upper ? where[axis].share : 1.0 - where[axis].share;
      index = index * count[axis] + std::min(where[axis].low + (upper ? 1 : 0), count[axis] - 1);
    }
    sum += weight * sigma[index];
  }
  return sum;
}

double FocusWidths::on(const TargetField& target) const noexcept {
  const double maximum = std::max(max_pressure(target), 1e-300);
  Vec3 middle = Vec3::Zero();
  double all = 0.0;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t cell = target.index(row, col);
      if (target.skin[cell] == 0) continue;
      const double p = target.pressure[cell] / maximum;
      const Vec2 x = target.position(row, col);
      middle += p * Vec3(x.x(), x.y(), target.height[cell]);
      all += p;
    }
  }
  const Vec3 p_D = target.X_DP * (all > 0.0 ? (middle / all).eval() : Vec3::Zero().eval());
  const double cosine = std::clamp(target.X_DP.linear()(2, 2), -1.0, 1.0);
  return at(p_D.z(), p_D.head<2>().norm(), std::acos(cosine));
}

void validate(const FocusWidths& widths) {
  if (widths.empty()) return;
  if (!ascends(widths.height) || !ascends(widths.offset) || !ascends(widths.tilt)) {
    throw std::invalid_argument("heights, offsets and tilts of focal widths must ascend");
  }
  const std::size_t places = widths.height.size() * widths.offset.size() * widths.tilt.size();
  if (widths.sigma.size() != places) {
    throw std::invalid_argument("there are " + std::to_string(widths.sigma.size()) +
                                " focal widths; there must be one for each of the " +
                                std::to_string(places) + " places");
  }
  for (const double sigma : widths.sigma) {
    if (!std::isfinite(sigma) || sigma < 1e-4 || sigma > 0.1) {
      throw std::invalid_argument("each focal width must be between 0.1 and 100 mm");
    }
  }
}

}  // namespace prostm
