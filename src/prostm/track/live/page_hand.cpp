#include "prostm/track/live/page_hand.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/track/detail/hand_skeleton.hpp"
#include "prostm/track/detail/hand_track.hpp"
#include "prostm/track/detail/track_settings.hpp"

namespace prostm {
namespace {

constexpr double kReach = 0.5;              // largest |coordinate| of the palm in D [m]
constexpr double kSilence = 0.5;            // a hand not placed for this long lapses [s]
constexpr double kGap = 0.4;                // longest time between poses that count as steady [s]
constexpr double kSteady = 1.0;             // steady poses that bring a lapsed hand back [s]
constexpr double kFollowRate = 40.0;        // ω of the spring [1/s]
constexpr double kLongestStep = 0.1;        // longest step of the spring, e.g. after a pause [s]
constexpr std::int64_t kFirstId = 1 << 30;  // above any tracker's ids

/// Returns a difference of two angles, the short way round.
double short_way(double angle) {
  return std::remainder(angle, 2.0 * kPi);
}

class AbsentHand final : public HandSource {
 public:
  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.clear();
  }
};

}  // namespace

PageHand::PageHand(const TrackSettings& settings) : settings_(settings), id_(kFirstId) {
  validate(settings);
}

bool PageHand::place(const PagePose& pose) noexcept {
  const double numbers[] = {pose.p_D.x(), pose.p_D.y(), pose.p_D.z(), pose.yaw,
                            pose.pitch,   pose.roll,    pose.closure};
  for (const double number : numbers) {
    if (!std::isfinite(number)) return false;
  }
  if (pose.p_D.cwiseAbs().maxCoeff() > kReach) return false;
  Message& message = newest_.draft();
  message.held = true;
  message.pose = pose;
  message.pose.yaw = std::clamp(pose.yaw, -kPi, kPi);
  message.pose.pitch = std::clamp(pose.pitch, -0.5 * kPi, 0.5 * kPi);
  message.pose.roll = std::clamp(pose.roll, -kPi, kPi);
  message.pose.closure = std::clamp(pose.closure, 0.0, 1.0);
  newest_.publish();
  return true;
}

void PageHand::release(bool hidden) noexcept {
  Message& message = newest_.draft();
  message.held = false;
  message.hidden = hidden;
  newest_.publish();
}

PageHandReport PageHand::report() const noexcept {
  return {state_.load(std::memory_order_relaxed), late_.load(std::memory_order_relaxed),
          hidden_.load(std::memory_order_relaxed)};
}

void PageHand::enter(PageHandState state) noexcept {
  const PageHandState before = state_.exchange(state, std::memory_order_relaxed);
  if (before == state) return;
  if (state == PageHandState::Late) late_.fetch_add(1, std::memory_order_relaxed);
  if (state == PageHandState::Hidden) hidden_.fetch_add(1, std::memory_order_relaxed);
}

void PageHand::receive(const Message& message, double time) noexcept {
  if (!message.held) return enter(message.hidden ? PageHandState::Hidden : PageHandState::Free);
  if (time - arrival_ > kGap) steady_since_ = time;
  arrival_ = time;
  const PageHandState before = state_.load(std::memory_order_relaxed);
  if (before == PageHandState::Late && time - steady_since_ < kSteady) return;
  const PagePose& pose = message.pose;
  // a hand of the other side is a new hand
  const bool same = before == PageHandState::Held && pose.side == side_;
  side_ = pose.side;
  target_ = {pose.p_D.x(), pose.p_D.y(), pose.p_D.z(), pose.yaw,
             pose.pitch,   pose.roll,    pose.closure};
  enter(PageHandState::Held);
  if (same) return;
  ++id_;
  motion_ = {target_, {}};
  last_time_ = time;
}

bool PageHand::sample(double time, Hand& out, double& age) noexcept {
  if (newest_.refresh()) receive(newest_.value(), time);
  if (state_.load(std::memory_order_relaxed) != PageHandState::Held) return false;
  if (time - arrival_ > kSilence) {
    enter(PageHandState::Late);
    return false;
  }
  follow(std::clamp(time - last_time_, 0.0, kLongestStep));
  last_time_ = time;
  age = time - arrival_;

  // central differences of the motion; their error is far below a millimetre per second
  constexpr double kDifference = 1e-4;  // [s]
  Hand before, after;
  pose_at(-kDifference, before);
  pose_at(kDifference, after);
  pose_at(0.0, out);
  out.id = id_;
  out.confidence = 1.0;
  out.inferred = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    out.velocity[j] = (after.position[j] - before.position[j]) / (2.0 * kDifference);
    clamp_length(settings_.max_speed, out.velocity[j]);
  }
  return true;
}

/// (H19), exact over dt: with e = value − target and c = rate + ω e at its start,
/// e(dt) = (e + c dt) exp(−ω dt).
void PageHand::follow(double dt) noexcept {
  if (!(dt > 0.0)) return;
  const double decay = std::exp(-kFollowRate * dt);
  std::array<double, kFreedom> step;
  for (std::size_t i = 0; i < kFreedom; ++i) {
    const bool angle = i >= 3 && i < 6;
    double e = motion_.value[i] - target_[i];
    if (angle) e = short_way(e);
    const double c = motion_.rate[i] + kFollowRate * e;
    step[i] = (e + c * dt) * decay - e;
    motion_.rate[i] = (motion_.rate[i] - kFollowRate * c * dt) * decay;
  }
  // no hand is faster than max_speed, however far the pointer jumps
  const double length = std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
  const double speed =
      std::sqrt(motion_.rate[0] * motion_.rate[0] + motion_.rate[1] * motion_.rate[1] +
                motion_.rate[2] * motion_.rate[2]);
  const double slower =
      std::min(1.0, settings_.max_speed / std::max({speed, length / dt, settings_.max_speed}));
  for (std::size_t i = 0; i < kFreedom; ++i) {
    if (i < 3) {
      step[i] *= slower;
      motion_.rate[i] *= slower;
    }
    motion_.value[i] += step[i];
  }
}

/// Poses the skeleton `offset` [s] from now at the present rates, in D.
void PageHand::pose_at(double offset, Hand& out) const noexcept {
  std::array<double, kFreedom> x;
  for (std::size_t i = 0; i < kFreedom; ++i) x[i] = motion_.value[i] + offset * motion_.rate[i];
  // the axes of H with all angles 0: x right, y up, z against the fingers, as T lies in D
  Pose X_DH = Pose::Identity();
  X_DH.linear() = (Eigen::AngleAxisd(x[3], Vec3::UnitZ()) * Eigen::AngleAxisd(x[4], Vec3::UnitX()) *
                   Eigen::AngleAxisd(x[5], Vec3::UnitY()))
                      .toRotationMatrix() *
                  default_tracker_pose().linear();
  X_DH.translation() = Vec3(x[0], x[1], x[2]);
  pose_skeleton(X_DH, x[6], side_, out);
}

HandSwitch::HandSwitch(std::unique_ptr<HandSource> base, std::shared_ptr<PageHand> page,
                       const Pose& X_DT)
    : base_(std::move(base)), page_(std::move(page)), X_TD_(X_DT.inverse()) {}

void HandSwitch::sample(double time, HandFrame& out) {
  // also while the page controls the hand, since the base needs every time
  base_->sample(time, out);
  Hand hand;
  double age = 0.0;
  if (!page_->sample(time, hand, age)) return;
  out.time = time;
  out.age = age;
  out.hands.clear();
  out.hands.push_back(hand);
  to_device(X_TD_, out);
}

std::unique_ptr<HandSource> make_absent_hand() {
  return std::make_unique<AbsentHand>();
}

}  // namespace prostm
