#include "prostm/device/safety/head_levels.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/device/safety/focus_levels.hpp"

namespace prostm {
namespace {

constexpr double kReference = 20e-6;      // rms acoustic pressure of 0 dB [Pa]
constexpr double kHandHeight = 0.2;       // above the array [m]
constexpr double kHandAngle = kPi / 4.0;  // from the axes, within which sound hits a hand
constexpr double kHandToHead = 0.1;       // at least [m]

double decibels(double squared_pressure) {
  return 10.0 * std::log10(squared_pressure / (kReference * kReference));
}

/// ∫ D² dΩ over the directions of a transducer that hit a hand [sr].
double solid_angle(const TransducerArray& array) {
  constexpr int kSteps = 2000;
  const double ka = wave_number(array, Medium{}) * array.radius;
  const double least = std::cos(kHandAngle);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = least + (1.0 - least) * (i + 0.5) / kSteps;
    const double d = directivity(array.directivity, ka, cosine);
    sum += d * d;
  }
  return 2.0 * kPi * (1.0 - least) * sum / kSteps;
}

constexpr ExposureLimit kLimits[] = {
    {"IRPA/INIRC 1984, public", 100.0, "from memory, not checked"},
    {"Health Canada Safety Code 24 (1991)", 110.0, "from memory, not checked"},
    {"consensus of occupational limits, under 4 h a day", 110.0,
     "Howard, Hansen & Zander 2004, as cited elsewhere"},
    {"ACGIH ceiling", 115.0, "from memory, not checked"},
    {"ACGIH ceiling with its allowance of 30 dB, where nothing carries sound into the body", 145.0,
     "from memory, not checked"},
};

}  // namespace

HeadLevel head_level(const TransducerArray& array, double distance) {
  Vec3 middle = Vec3::Zero(), axis = Vec3::Zero();
  for (const Vec3& p : array.position) middle += p;
  for (const Vec3& n : array.normal) axis += n;
  const auto count = static_cast<double>(array.position.size());
  middle /= count;
  axis = axis.norm() > 1e-3 * count ? Vec3(axis.normalized()) : Vec3(Vec3::UnitZ());
  const Vec3 head = middle + distance * axis;

  const double ka = wave_number(array, Medium{}) * array.radius;
  double sum = 0.0, squares = 0.0;  // of D/r
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    const Vec3 d = head - array.position[i];
    const double r = std::max(d.norm(), 10e-3);
    const double share = directivity(array.directivity, ka, d.dot(array.normal[i]) / r) / r;
    sum += share;
    squares += share * share;
  }
  const double from_hand = std::max(kHandToHead, std::abs(distance - kHandHeight));
  const double reflected = count * solid_angle(array) / (2.0 * kPi * from_hand * from_hand);
  const double least = smallest_amplitude(array), most = largest_amplitude(array);
  return {distance, decibels(least * least * squares),
          decibels(most * most * (squares + reflected)), decibels(4.0 * most * most * sum * sum)};
}

std::span<const ExposureLimit> exposure_limits() {
  return kLimits;
}

}  // namespace prostm
