#include "prostm/emit/detail/start_place.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace prostm {
namespace {

constexpr std::size_t kPlaces = 32, kLaps = 2;
constexpr double kMm = 1e3;            // per metre
constexpr float kLeastSquare = 1e-3F;  // added to squared distances: keeps costs finite [mm²]

}  // namespace

PathPlace first_place(const LiftedPath& path) {
  PathPlace place;
  place.p_D = path.p_D[0];
  return place;
}

PathPlace place_apart(const LiftedPath& path, const FocusMotion& motion,
                      std::span<const FocusMotion* const> others) {
  const std::int64_t lap = motion.lap_samples(path);
  if (lap == 1) return first_place(path);  // it rests there
  // two laps, so that the places of all starts at one moment are contiguous
  std::array<std::array<float, 2 * kPlaces>, 3> round;
  for (std::size_t i = 0; i < 2 * kPlaces; ++i) {
    const double share = static_cast<double>(i % kPlaces) / static_cast<double>(kPlaces);
    const Vec3 p = kMm * point_at(path, share * path.length).p_D;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      round[axis][i] = static_cast<float>(p[static_cast<Eigen::Index>(axis)]);
    }
  }

  std::array<float, kPlaces> cost{};
  for (std::size_t moment = 0; moment < kLaps * kPlaces; ++moment) {
    const auto samples = static_cast<std::int64_t>(
        static_cast<double>(moment) * static_cast<double>(lap) / static_cast<double>(kPlaces));
    const std::size_t at = moment % kPlaces;
    for (const FocusMotion* other : others) {
      const Eigen::Vector3f p = (kMm * other->ahead(samples)).cast<float>();
      for (std::size_t start = 0; start < kPlaces; ++start) {
        const float dx = round[0][at + start] - p.x(), dy = round[1][at + start] - p.y(),
                    dz = round[2][at + start] - p.z();
        const float inverse = 1.0F / (dx * dx + dy * dy + dz * dz + kLeastSquare);
        cost[start] += inverse * inverse * inverse * inverse;
      }
    }
  }
  const auto start = std::min_element(cost.begin(), cost.end()) - cost.begin();
  PathPlace place;
  place.s = path.length * static_cast<double>(start) / static_cast<double>(kPlaces);
  place.p_D = point_at(path, place.s).p_D;
  return place;
}

}  // namespace prostm
