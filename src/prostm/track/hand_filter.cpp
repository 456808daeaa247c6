#include <algorithm>
#include <cmath>

#include "prostm/track/detail/track_settings.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

/// (H5): returns `share` for a small innovation, and about 1 for one far above `scale`.
double opened(double share, double squared_innovation, double scale) {
  return share + (1.0 - share) * squared_innovation / (squared_innovation + scale * scale);
}

void filter_joint(const TrackSettings& settings, double dt, std::size_t j, const Hand& last,
                  Hand& hand) {
  // (H6): predict with the filtered velocity, correct by a share of the innovation
  const Vec3 predicted = last.position[j] + dt * last.velocity[j];
  const Vec3 innovation = hand.position[j] - predicted;
  const double alpha =
      opened(settings.filter_position, innovation.squaredNorm(), settings.filter_position_scale);
  hand.position[j] = predicted + alpha * innovation;

  // (H7): the velocity of the skin pushes air, so it is smoothed harder than the position
  const Vec3 change = hand.velocity[j] - last.velocity[j];
  const double gamma =
      opened(settings.filter_velocity, change.squaredNorm(), settings.filter_velocity_scale);
  hand.velocity[j] = last.velocity[j] + gamma * change;

  // an angle counts as the arc it makes at the length of a finger
  constexpr double kFingerLength = 0.1;  // [m]
  const double arc = kFingerLength * last.orientation[j].angularDistance(hand.orientation[j]);
  const double beta = opened(settings.filter_position, arc * arc, settings.filter_position_scale);
  hand.orientation[j] = last.orientation[j].slerp(beta, hand.orientation[j]).normalized();
  hand.radius[j] = last.radius[j] + settings.filter_position * (hand.radius[j] - last.radius[j]);
}

}  // namespace

HandFilter::HandFilter(const TrackSettings& settings) : settings_(settings) {
  validate(settings);
}

void HandFilter::apply(double dt, HandFrame& frame) noexcept {
  for (Hand& hand : frame.hands) {
    const auto last = std::find_if(
        state_.hands.begin(), state_.hands.end(),
        [&](const Hand& known) { return known.id == hand.id && known.side == hand.side; });
    if (last == state_.hands.end()) continue;
    for (std::size_t j = 0; j < kJointCount; ++j) filter_joint(settings_, dt, j, *last, hand);
  }
  state_ = frame;
}

}  // namespace prostm
