#include "prostm/device/safety/head_levels.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/device/safety/focus_levels.hpp"
#include "prostm/device/safety/safety_settings.hpp"

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
    {100.0, "IRPA/INIRC 1984", "public, at any time", "Health Phys. 46, 969"},
    {110.0, "Health Canada 1991", "public and at work", "Safety Code 24, table 5"},
    {110.0, "consensus of limits, 2004", "at work, under 4 h a day",
     "Howard, Hansen & Zander, J. Occup. Health Safety 21, 253"},
    {115.0, "ACGIH", "at work, at any time; 30 dB more if nothing couples sound into the body",
     "as quoted by Howard, Hansen & Zander 2004"},
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
  const double absorption = wave(array, Medium{}).absorption;
  double sum = 0.0, squares = 0.0, absorbed = 0.0;  // of D/r; squares with absorption
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    const Vec3 d = head - array.position[i];
    const double r = std::max(d.norm(), 10e-3);
    const double share = directivity(array.directivity, ka, d.dot(array.normal[i]) / r) / r;
    sum += share;
    squares += share * share;
    absorbed += share * share * std::exp(-2.0 * absorption * r);
  }
  const double from_hand = std::max(kHandToHead, std::abs(distance - kHandHeight));
  const double reflected = count * solid_angle(array) / (2.0 * kPi * from_hand * from_hand);
  const double by_way = std::exp(-2.0 * absorption * (kHandHeight + from_hand));
  const double least = smallest_amplitude(array), likely = likely_amplitude(array),
               most = largest_amplitude(array);
  return {.distance = distance,
          .low = decibels(least * least * absorbed),
          .likely = decibels(likely * likely * (absorbed + by_way * reflected)),
          .estimate = decibels(most * most * (squares + reflected)),
          .bound = decibels(4.0 * most * most * sum * sum)};
}

std::array<RecommendedLevel, 2> recommended_levels(const HeadLevel& head) {
  constexpr double kAtEar = 110.0, kProtection = 20.0;  // [dB]
  const auto under = [&](const char* use, double protection, const char* advice) {
    const double allowed = head.estimate - (head.likely - protection - kAtEar);
    const double cap = std::min(std::floor(allowed), SafetySettings{}.head_level);
    const double taken = std::max(0.0, head.estimate - cap);
    return RecommendedLevel{use, cap, head.likely - taken, protection, 2.0 * taken, advice};
  };
  return {under("study", kProtection,
                "everybody in the room wears hearing protection of at least 20 dB at 40 kHz; "
                "measure the level at the head first"),
          under("demo", 0.0,
                "nobody wears hearing protection; if too little is felt, hand out protection and "
                "use the setting for a study")};
}

std::span<const ExposureLimit> exposure_limits() {
  return kLimits;
}

}  // namespace prostm
