#include "prostm/track/palm.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using namespace literals;

// of the hand of average size, detail/hand_skeleton.hpp
constexpr double kLength = 90.3_mm, kBreadth = 57.7_mm;

}  // namespace

Palm palm_of(const Hand& hand) {
  const Vec3 &wrist = hand.position[kWrist], &index = hand.position[kIndexProximal],
             &middle = hand.position[kMiddleProximal], &little = hand.position[kLittleProximal];
  Palm out;
  out.centre = hand.position[kPalm];
  const Vec3 along = middle - wrist, across = (index - wrist).cross(little - wrist);
  if (along.head<2>().norm() > 0.0) out.yaw = std::atan2(-along.x(), along.y());
  if (across.norm() > 0.0)
    out.tilt = std::acos(std::min(1.0, std::abs(across.z()) / across.norm()));
  out.size = 0.5 * (along.norm() / kLength + (index - little).norm() / kBreadth);
  for (const int knuckle : {kIndexProximal, kMiddleProximal, kRingProximal, kLittleProximal}) {
    const auto first = hand.position.begin() + knuckle;
    double bones = 0.0;
    for (int b = 0; b < 3; ++b) bones += (first[b + 1] - first[b]).norm();
    if (bones > 0.0)
      out.straightness = std::min(out.straightness, (first[3] - first[0]).norm() / bones);
  }
  return out;
}

}  // namespace prostm
