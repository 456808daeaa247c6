#include "prostm/acoustics/field/propagation.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace prostm {
namespace {

[[noreturn]] void refuse(std::size_t focus, const std::string& problem) {
  throw std::invalid_argument("focal point " + std::to_string(focus + 1) + " " + problem);
}

void check(const TransducerArray& array, std::span<const Vec3> foci) {
  if (foci.empty() || foci.size() > array.position.size()) {
    throw std::invalid_argument(
        "there are " + std::to_string(foci.size()) + " focal points; there must be from 1 to " +
        std::to_string(array.position.size()) + ", one for each transducer");
  }
  for (std::size_t m = 0; m < foci.size(); ++m) {
    for (const double x : foci[m]) {
      if (!std::isfinite(x)) refuse(m, "must have finite coordinates");
    }
    bool in_front = array.directivity == Directivity::Omni;
    for (std::size_t n = 0; n < array.position.size(); ++n) {
      const Vec3 way = foci[m] - array.position[n];
      if (way.norm() < kNearestPoint) {
        refuse(m, "is on transducer " + std::to_string(n) +
                      " (from 0); it must be at least 10 mm from every transducer");
      }
      in_front = in_front || way.dot(array.normal[n]) > 0.0;
    }
    if (!in_front) refuse(m, "is behind the array; it must be in front of a transducer");
    for (std::size_t other = 0; other < m; ++other) {
      if ((foci[m] - foci[other]).norm() >= kNearestFoci) continue;
      refuse(m, "is at the position of focal point " + std::to_string(other + 1) +
                    "; they must be at least 0.1 mm apart");
    }
  }
}

}  // namespace

Propagation propagation_to(const TransducerArray& array, const Medium& medium,
                           std::span<const Vec3> foci) {
  check(array, foci);
  const Wave sound = wave(array, medium);
  Propagation g(static_cast<Eigen::Index>(foci.size()),
                static_cast<Eigen::Index>(array.position.size()));
  for (std::size_t m = 0; m < foci.size(); ++m) {
    for (std::size_t n = 0; n < array.position.size(); ++n) {
      g(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) =
          propagate(array, sound, n, foci[m]);
    }
  }
  return g;
}

}  // namespace prostm
