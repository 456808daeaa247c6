#include "prostm/plan/patches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prostm/plan/detail/raster_rows.hpp"
#include "prostm/target/pressure_share.hpp"

namespace prostm::planning {
namespace {

constexpr double kSmallestCell = 1e-6, kLargestCell = 1.0;  // [m]
constexpr double kLargestPressure = 1e300;                  // keeps sums and γ p* finite

/// Whether the weights, if any, meet the conditions of validate().
bool has_good_weights(const TargetField& target) {
  if (target.weight.empty()) return true;
  if (target.weight.size() != target.size()) return false;
  const double largest =
      checked_maximum(target.weight, target.skin, std::numeric_limits<double>::max());
  return largest > 0.0 ||
         (largest == 0.0 && std::count(target.skin.begin(), target.skin.end(), 0) ==
                                static_cast<std::ptrdiff_t>(target.size()));
}

}  // namespace

double highest_pressure(const TargetField& target, std::size_t max_cells) {
  const std::size_t n = target.pressure.size();
  if (target.rows < 1 || target.cols < 1 || n > max_cells || target.skin.size() != n ||
      static_cast<std::size_t>(target.rows) * static_cast<std::size_t>(target.cols) != n) {
    return -1.0;
  }
  if (!std::isfinite(target.cell) || target.cell < kSmallestCell || target.cell > kLargestCell ||
      !std::isfinite(target.origin.x()) || !std::isfinite(target.origin.y())) {
    return -1.0;
  }
  if (!has_good_weights(target)) return -1.0;
  return checked_maximum(target.pressure, target.skin, kLargestPressure);
}

std::array<int, kMaxPatches> share_out(const PatchPressures& pressure, int count) {
  std::array<int, kMaxPatches> share{};
  const double most = *std::max_element(pressure.begin(), pressure.end());
  const auto need = [&](std::size_t i) {
    return std::pair(share[i] == 0, pressure_share(pressure[i], most) / (share[i] + 1));
  };
  for (int given = 0; given < count; ++given) {
    std::size_t neediest = kMaxPatches;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
      if (pressure[i] > 0.0 && (neediest == kMaxPatches || need(i) > need(neediest))) neediest = i;
    }
    if (neediest == kMaxPatches) break;
    ++share[neediest];
  }
  return share;
}

}  // namespace prostm::planning
