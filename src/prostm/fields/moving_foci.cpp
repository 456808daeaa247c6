#include "prostm/fields/moving_foci.hpp"

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm::fields {
namespace {

constexpr double kRadius = 0.140 / (2.0 * kPi);  // [m]
constexpr double kSpeed = 7.0;                   // [m/s]

}  // namespace

MovingFoci::MovingFoci(std::uint64_t seed, int count, double apart) {
  Random random(seed);
  while (static_cast<int>(paths_.size()) < count) {
    // one after the other, so that no compiler changes their order
    const double z = random.uniform(0.18, 0.22), y = random.uniform(-0.05, 0.05),
                 x = random.uniform(-0.05, 0.05);
    const Vec3 centre(x, y, z);
    bool far = true;
    for (const Path& other : paths_) {
      far = far && (centre - other.centre).head<2>().norm() > apart;
    }
    if (!far) continue;
    const double direction = random.below(2) == 0 ? 1.0 : -1.0;
    const double start = random.uniform(0.0, 2.0 * kPi), flatness = random.uniform(0.5, 1.0);
    const double lobes = 1.0 + random.below(2), shift = random.uniform(0.0, 2.0 * kPi);
    paths_.push_back({centre, start, direction * kSpeed / kRadius, flatness, lobes, shift});
  }
}

Vec3 MovingFoci::position(int focus, double time) const {
  const Path& path = paths_[static_cast<std::size_t>(focus)];
  const double angle = path.start + path.rate * time;
  return path.centre + kRadius * Vec3(std::cos(angle), path.flatness * std::sin(angle), 0.0);
}

double MovingFoci::amplitude(int focus, double time) const {
  const Path& path = paths_[static_cast<std::size_t>(focus)];
  const double angle = path.start + path.rate * time;
  return std::sqrt(0.55 + 0.45 * std::cos(path.lobes * angle + path.shift));
}

}  // namespace prostm::fields
