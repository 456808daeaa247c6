#include "plumes/held_hand.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/core/units.hpp"
#include "prostm/io/hand/hand_file.hpp"

namespace prostm::bench {
namespace {

constexpr double kRate = 100.0;  // frames a second [Hz]
// length of the tremor, and of the part over which its end is blended into its beginning [frames]
constexpr std::size_t kStill = 200, kBlend = 20;
constexpr double kLength = 60.0;  // duration of a recording of a trembling hand [s]

/// Turns a hand in D about its palm joint until the palm is level and points along +y, then
/// tilts it, and moves it.
void place(const Hold& hold, Hand& hand) {
  const Vec3 centre = hand.position[kPalm];
  const Vec3 along = hand.position[kMiddleProximal] - hand.position[kWrist];
  Vec3 up = (hand.position[kLittleProximal] - hand.position[kWrist])
                .cross(hand.position[kIndexProximal] - hand.position[kWrist]);
  if (hand.side == Side::Left) up = -up;
  // columns: the hand's right, forwards and up, in D
  Eigen::Matrix3d R_DH;
  R_DH.col(2) = up.normalized();
  R_DH.col(1) = (along - along.dot(R_DH.col(2)) * R_DH.col(2)).normalized();
  R_DH.col(0) = R_DH.col(1).cross(R_DH.col(2));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(hold.tilt, Vec3::UnitY()).toRotationMatrix() * R_DH.transpose();
  const Vec3 to(hold.x, hold.y, hold.height);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = to + turn * (hand.position[j] - centre);
    hand.orientation[j] = Quat(turn) * hand.orientation[j];
    hand.velocity[j] = Vec3::Zero();
  }
}

/// Transforms a hand to T, the frame of sources.
void to_tracker(Hand& hand) {
  const Pose X_TD = default_tracker_pose().inverse();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = X_TD * hand.position[j];
    hand.orientation[j] = Quat(X_TD.linear()) * hand.orientation[j];
  }
}

/// A source with the same hand at all times.
class StillHand final : public HandSource {
 public:
  explicit StillHand(const Hand& hand) : hand_(hand) {}

  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.assign(1, hand_);
  }

 private:
  Hand hand_;
};

/// Returns one hand per frame, kRate frames a second, in T.
std::vector<Hand> hands_of(const std::string& path) {
  HandRecording recording = read_hand_recording(path);
  const auto source = make_recorded_hand(std::move(recording), {}, false, 0.02);
  std::vector<Hand> hands;
  HandFrame frame;
  const double length = source->recording_length();
  for (double t = 0.0; t <= length; t += 1.0 / kRate) {
    source->sample(t, frame);
    if (!frame.hands.empty()) hands.push_back(frame.hands.front());
  }
  if (hands.empty()) throw InputError(path + " has no hand");
  return hands;
}

/// Returns the first of the `count` consecutive frames in which the palm moves least.
std::size_t stillest(const std::vector<Hand>& hands, std::size_t count) {
  std::size_t best = 0;
  double least = 1e9;
  for (std::size_t first = 0; first + count <= hands.size(); first += 10) {
    double most = 0.0;
    for (std::size_t i = first; i < first + count; ++i)
      most = std::max(most, (hands[i].position[kPalm] - hands[first].position[kPalm]).norm());
    if (most < least && hands[first].id == hands[first + count - 1].id) {
      least = most;
      best = first;
    }
  }
  return best;
}

/// Returns the largest distance of a fingertip from the plane of wrist, index and little knuckle
/// [m].
double bent(const Hand& hand) {
  const Vec3& wrist = hand.position[kWrist];
  const Vec3 normal = (hand.position[kLittleProximal] - wrist)
                          .cross(hand.position[kIndexProximal] - wrist)
                          .normalized();
  double most = 0.0;
  for (const int tip : {kIndexTip, kMiddleTip, kRingTip, kLittleTip}) {
    const auto j = static_cast<std::size_t>(tip);
    most = std::max(most, std::abs(normal.dot(hand.position[j] - wrist)));
  }
  return most;
}

/// Returns the palm's fast movement at frame i: its place minus the mean with the weights of a
/// Gaussian whose gain at `cutoff` [Hz] is 1/√2.
Vec3 fast_part(const std::vector<Hand>& hands, std::size_t i, double cutoff) {
  const double sigma = kRate * std::sqrt(std::log(2.0)) / (2.0 * kPi * cutoff);  // [frames]
  const auto reach = static_cast<std::size_t>(std::ceil(4.0 * sigma));
  Vec3 sum = Vec3::Zero();
  double weights = 0.0;
  for (std::size_t j = i - std::min(i, reach); j <= std::min(i + reach, hands.size() - 1); ++j) {
    const double away = (static_cast<double>(j) - static_cast<double>(i)) / sigma;
    const double weight = std::exp(-0.5 * away * away);
    sum += weight * hands[j].position[kPalm];
    weights += weight;
  }
  return hands[i].position[kPalm] - sum / weights;
}

/// Returns the palm's tremor in the stillest part of a recording, made to repeat without a jump.
std::vector<Vec3> tremor_of(const std::vector<Hand>& hands, double cutoff) {
  const std::size_t count = std::min(kStill + kBlend, hands.size());
  const std::size_t first = stillest(hands, count), blend = std::min(kBlend, count / 2);
  std::vector<Vec3> tremor(count - blend);
  for (std::size_t i = 0; i < tremor.size(); ++i) tremor[i] = fast_part(hands, first + i, cutoff);
  for (std::size_t i = 0; i < blend; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(blend);
    tremor[i] = u * tremor[i] + (1.0 - u) * fast_part(hands, first + tremor.size() + i, cutoff);
  }
  return tremor;
}

/// Returns a recording of a hand that trembles, in T.
HandRecording held(const Hand& hand, const std::vector<Vec3>& tremor, double length) {
  HandRecording recording;
  const auto frames = static_cast<std::size_t>(std::ceil(length * kRate)) + 1;
  for (std::size_t i = 0; i < frames; ++i) {
    HandFrame frame;
    frame.time = static_cast<double>(i) / kRate;
    frame.hands.assign(1, hand);
    for (Vec3& p : frame.hands.front().position) p += tremor[i % tremor.size()];
    recording.frames.push_back(frame);
  }
  return recording;
}

}  // namespace

std::unique_ptr<HandSource> make_held_hand(const std::string& recording, const Hold& hold) {
  const std::vector<Hand> hands = hands_of(recording);
  const auto flattest = std::min_element(
      hands.begin(), hands.end(), [](const Hand& a, const Hand& b) { return bent(a) < bent(b); });
  HandFrame frame;
  frame.hands.assign(1, *flattest);
  to_device(default_tracker_pose(), frame);
  Hand hand = frame.hands.front();
  place(hold, hand);
  to_tracker(hand);
  hand.id = 1;
  if (hold.tremor_above == 0.0) return std::make_unique<StillHand>(hand);
  return make_recorded_hand(held(hand, tremor_of(hands, hold.tremor_above), kLength), {}, false,
                            1.0 / kRate);
}

std::unique_ptr<HandSource> make_still_hand(HandSource& source, const Hold& hold) {
  HandFrame frame;
  source.sample(0.0, frame);
  to_device(default_tracker_pose(), frame);
  Hand hand = frame.hands.front();
  place(hold, hand);
  to_tracker(hand);
  return std::make_unique<StillHand>(hand);
}

std::unique_ptr<HandSource> make_finger(double x, double y, double height) {
  HandFrame frame;
  make_study_hand({})->sample(0.0, frame);
  to_device(default_tracker_pose(), frame);
  Hand hand = frame.hands.front();
  constexpr int kEnds[][2] = {{kThumbMetacarpal, kThumbTip},
                              {kMiddleProximal, kMiddleTip},
                              {kRingProximal, kRingTip},
                              {kLittleProximal, kLittleTip}};
  for (const auto& [first, last] : kEnds) {
    for (int j = first + 1; j <= last; ++j) {
      const auto joint = static_cast<std::size_t>(j), end = static_cast<std::size_t>(first);
      hand.position[joint] = hand.position[end];
      hand.radius[joint] = hand.radius[end];
    }
  }
  const Vec3 pad = 0.5 * (hand.position[kIndexDistal] + hand.position[kIndexTip]);
  const Vec3 to = Vec3(x, y, height) - pad;
  for (Vec3& p : hand.position) p += to;
  to_tracker(hand);
  return std::make_unique<StillHand>(hand);
}

}  // namespace prostm::bench
