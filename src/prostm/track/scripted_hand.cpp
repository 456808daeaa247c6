/// The scripted hand, which needs no file.

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/track/detail/hand_skeleton.hpp"
#include "prostm/track/detail/hand_track.hpp"
#include "prostm/track/detail/track_settings.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

constexpr double kTrackerRate = 110.0;  // frame rate of the tracker whose noise is imitated [Hz]

/// The hand as the script describes it.
struct Gesture {
  double x = 0, y = 0, z = 0;  // palm joint relative to its hovering position, in T [m]
  double roll = 0, pitch = 0;  // about T's z and x [rad]
  double closure = 0;
};

struct Key {
  double phase;  // share of the cycle, 0..1
  Gesture gesture;
};

// before the first key and after the last one the hand is out of sight
constexpr Key kScript[] = {
    {0.02, {0.00, 0.03, 0.26, 0.00, 0.00, 0.0}},  // at the user's side of the box
    {0.12, {0.00, 0.00, 0.00, 0.00, 0.00, 0.0}},  // hover
    {0.27, {0.01, 0.00, -0.01, 0.00, 0.00, 0.0}},
    {0.34, {0.00, -0.07, 0.00, 0.00, 0.00, 0.0}},  // lower
    {0.38, {0.00, -0.07, 0.00, 0.00, 0.00, 0.0}},
    {0.46, {0.00, 0.04, 0.00, 0.00, 0.00, 0.0}},  // lift
    {0.51, {0.00, 0.00, 0.00, 0.00, 0.00, 0.0}},
    {0.56, {0.00, 0.00, 0.00, 0.35, 0.00, 0.0}},  // tilt to both sides and forwards
    {0.61, {0.00, 0.00, 0.00, -0.35, 0.00, 0.0}},
    {0.66, {0.00, 0.00, 0.00, 0.00, 0.30, 0.0}},
    {0.70, {0.00, 0.00, 0.00, 0.00, 0.00, 0.0}},
    {0.76, {0.00, 0.00, 0.00, 0.00, 0.00, 0.9}},  // close and open
    {0.78, {0.00, 0.00, 0.00, 0.00, 0.00, 0.9}},
    {0.84, {0.00, 0.00, 0.00, 0.00, 0.00, 0.0}},
    {0.88, {0.00, 0.00, 0.00, 0.00, 0.00, 0.0}},
    {0.97, {0.00, 0.03, 0.26, 0.00, 0.00, 0.0}}};  // leave

/// The gesture at a phase: every quantity moves from key to key with the least jerk, 10 s³ − 15 s⁴
/// + 6 s⁵ (H4), and so rests at each key. The first and the last key hold outside.
Gesture gesture_at(double phase) {
  if (phase <= std::begin(kScript)->phase) return std::begin(kScript)->gesture;
  if (phase >= std::prev(std::end(kScript))->phase) return std::prev(std::end(kScript))->gesture;
  const Key* next = std::upper_bound(std::begin(kScript), std::end(kScript), phase,
                                     [](double p, const Key& key) { return p < key.phase; });
  const Gesture &from = std::prev(next)->gesture, &to = next->gesture;
  const double s = (phase - std::prev(next)->phase) / (next->phase - std::prev(next)->phase);
  const double u = s * s * s * (10.0 + s * (6.0 * s - 15.0));
  const auto between = [u](double a, double b) { return a + u * (b - a); };
  return {between(from.x, to.x),         between(from.y, to.y),
          between(from.z, to.z),         between(from.roll, to.roll),
          between(from.pitch, to.pitch), between(from.closure, to.closure)};
}

class ScriptedHand final : public HandSource {
 public:
  ScriptedHand(const ScriptedHandSettings& settings, const TrackSettings& track)
      : settings_(settings), track_(track) {
    validate(settings);
    validate(track);
    const auto frames = static_cast<std::size_t>(2.0 * track.smoothing_time * kTrackerRate) + 8;
    window_.times.reserve(frames);
    window_.hands.reserve(frames);
  }

  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.clear();
    if (!(time >= 0.0)) return;
    const double cycle = settings_.still ? 0.0 : std::floor(time / settings_.period);
    const double start = cycle * settings_.period;
    if (!settings_.still && !visible((time - start) / settings_.period)) return;
    out.hands.emplace_back();
    if (settings_.jitter > 0.0) {
      sample_noisy(time, start, out.hands.back());
    } else {
      sample_exact(time, start, out.hands.back());
    }
    out.hands.back().id = static_cast<std::int64_t>(std::min(cycle, 1e15)) + 1;
  }

 private:
  static bool visible(double phase) {
    return phase >= std::begin(kScript)->phase && phase <= std::prev(std::end(kScript))->phase;
  }

  /// Poses the skeleton at `time` in the cycle that starts at `start`.
  void pose(double time, double start, Hand& hand) const {
    Gesture gesture;
    if (!settings_.still) gesture = gesture_at((time - start) / settings_.period);
    Pose X_TH = Pose::Identity();
    X_TH.linear() = (Eigen::AngleAxisd(gesture.roll, Vec3::UnitZ()) *
                     Eigen::AngleAxisd(gesture.pitch, Vec3::UnitX()))
                        .toRotationMatrix();
    X_TH.translation() = Vec3(gesture.x, settings_.height + gesture.y, gesture.z);
    pose_skeleton(X_TH, gesture.closure, Side::Right, hand);
    hand.confidence = 1.0;
    hand.inferred = 0;
  }

  void sample_exact(double time, double start, Hand& hand) const {
    // central differences of the motion itself; their error is far below a nanometre per second
    constexpr double kDifference = 1e-4;  // [s]
    Hand before, after;
    pose(time - kDifference, start, before);
    pose(time + kDifference, start, after);
    pose(time, start, hand);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      hand.velocity[j] = (after.position[j] - before.position[j]) / (2.0 * kDifference);
      clamp_length(track_.max_speed, hand.velocity[j]);
    }
  }

  void sample_noisy(double time, double start, Hand& hand) {
    // the tracker's frames in the window of (H1), within the time that the hand is in sight
    double first = time - track_.smoothing_time, last = time + track_.smoothing_time;
    if (!settings_.still) {
      first = std::max(first, start + std::begin(kScript)->phase * settings_.period);
      last = std::min(last, start + std::prev(std::end(kScript))->phase * settings_.period);
    }
    window_.times.clear();
    window_.hands.clear();
    const double first_frame = std::floor(first * kTrackerRate),
                 last_frame = std::ceil(last * kTrackerRate);
    for (double frame = first_frame; frame <= last_frame; frame += 1.0) {
      window_.times.push_back(frame / kTrackerRate);
      window_.hands.emplace_back();
      pose(window_.times.back(), start, window_.hands.back());
      add_noise(static_cast<std::int64_t>(frame), window_.hands.back());
    }
    const auto after = std::upper_bound(window_.times.begin(), window_.times.end(), time);
    sample_track(window_, static_cast<std::size_t>(after - window_.times.begin()) - 1, time, track_,
                 hand);
  }

  /// Adds white noise that depends only on the seed and the frame's number.
  void add_noise(std::int64_t frame, Hand& hand) const {
    // spreads neighbouring frames over the seeds
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;
    Random random((static_cast<std::uint64_t>(frame) + 1) * kGolden ^
                  static_cast<std::uint64_t>(settings_.seed));
    for (Vec3& p : hand.position) {
      for (int axis = 0; axis < 3; ++axis) p[axis] += settings_.jitter * random.normal();
    }
  }

  ScriptedHandSettings settings_;
  TrackSettings track_;
  HandTrack window_;  // scratch of sample_noisy
};

}  // namespace

std::unique_ptr<HandSource> make_scripted_hand(const ScriptedHandSettings& settings,
                                               const TrackSettings& track) {
  return std::make_unique<ScriptedHand>(settings, track);
}

}  // namespace prostm
