#include "prostm/emit/drive.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

// 40 steps of 1/40 add up to 1 except for rounding; the last step includes the remainder
constexpr double kRounding = 1e-9;

double slewed(const Drive& drive, double max_rise) {
  const double step = drive.wanted - drive.intensity;
  if (step > max_rise + kRounding) return drive.intensity + max_rise;
  if (step < -drive.max_fall - kRounding) return drive.intensity - drive.max_fall;
  return drive.wanted;
}

}  // namespace

double drive_intensity(double pressure, double full_scale, double silent_below, bool& saturated) {
  saturated = pressure > full_scale;
  if (saturated) return 1.0;
  const double share = pressure / full_scale;
  return share > 0.0 && share >= silent_below ? std::sqrt(share) : 0.0;
}

double even_share(int paths, double power_limit) {
  return std::min(1.0, power_limit / paths);
}

double largest_slew(double fade_time, double sample_rate) {
  constexpr double kMaxSlew = 1.0 / 40.0;
  return std::min(kMaxSlew, 1.0 / (fade_time * sample_rate));
}

bool limit_drives(std::span<Drive> drives, double max_rise, double power_limit) noexcept {
  // a common scale for the wanted intensities
  double power = 0.0;
  for (const Drive& drive : drives) power += drive.wanted * drive.wanted;
  const bool limited = power > power_limit;
  if (limited) {
    const double scale = std::sqrt(power_limit / power);
    for (Drive& drive : drives) drive.wanted *= scale;
  }

  // each by its own slew
  std::array<double, kMaxPaths> moved{};
  power = 0.0;
  for (std::size_t f = 0; f < drives.size(); ++f) {
    moved[f] = slewed(drives[f], max_rise);
    power += moved[f] * moved[f];
  }

  // above the limit if one rises faster than another falls: then all move by the same share of
  // their change, since a straight line between two points of a ball stays inside it
  if (power > power_limit) {
    double share = 1.0;
    for (const Drive& drive : drives) {
      const double step = drive.wanted - drive.intensity;
      if (step > max_rise) share = std::min(share, max_rise / step);
      if (step < -drive.max_fall) share = std::min(share, drive.max_fall / -step);
    }
    for (std::size_t f = 0; f < drives.size(); ++f) {
      moved[f] = drives[f].intensity + share * (drives[f].wanted - drives[f].intensity);
    }
  }
  for (std::size_t f = 0; f < drives.size(); ++f) drives[f].intensity = moved[f];
  return limited;
}

}  // namespace prostm
