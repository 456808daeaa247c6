#include "prostm/am/am_pressures.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace prostm {

void set_pressures(const TargetField& target, double sigma, FocalPoints& foci) {
  if (foci.empty()) return;
  constexpr double kReach = 5.0;  // [σ]
  const double reach2 = kReach * kReach * sigma * sigma, maximum = max_pressure(target);
  struct Sums {
    double product = 0.0, square = 0.0;  // sums with p* relative to its maximum
    bool reaches = false;
  };
  std::array<Sums, kMaxPaths> sums;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] == 0) continue;
    const Vec2 x = target.position(i);
    std::size_t nearest = 0;
    double distance2 = (x - foci[0].position).squaredNorm();
    for (std::size_t k = 1; k < foci.size(); ++k) {
      const double d2 = (x - foci[k].position).squaredNorm();
      if (d2 >= distance2) continue;
      distance2 = d2;
      nearest = k;
    }
    const double phi = std::exp(-0.5 * distance2 / (sigma * sigma));
    Sums& own = sums[nearest];
    if (target.pressure[i] > 0.0) own.product += target.pressure[i] / maximum * phi;
    own.square += phi * phi;
    own.reaches = own.reaches || distance2 <= reach2;
  }

  FocalPoints kept;
  for (std::size_t k = 0; k < foci.size(); ++k) {
    if (!sums[k].reaches) continue;
    kept.push_back(foci[k]);
    kept.back().pressure = maximum * (sums[k].product / sums[k].square);
  }
  foci = kept;
}

}  // namespace prostm
