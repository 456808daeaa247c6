#include "plumes/held_hand.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/io/hand_file.hpp"

namespace prostm::bench {
namespace {

constexpr double kStill = 2.0;   // length of the tremor that is taken [s]
constexpr double kRate = 100.0;  // its samples a second [Hz]

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

/// Gives hands in T, as sources do.
void to_tracker(Hand& hand) {
  const Pose X_TD = default_tracker_pose().inverse();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = X_TD * hand.position[j];
    hand.orientation[j] = Quat(X_TD.linear()) * hand.orientation[j];
  }
}

class HeldHand final : public HandSource {
 public:
  HeldHand(const Hand& hand, std::vector<Vec3> tremor) : hand_(hand), tremor_(std::move(tremor)) {}

  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.assign(1, hand_);
    if (tremor_.size() < 2) return;
    Hand& hand = out.hands.front();
    // to and fro, linear between samples
    const auto last = static_cast<double>(tremor_.size() - 1);
    const double phase = std::fmod(time * kRate, 2.0 * last);
    const bool back = phase >= last;
    const double at = back ? 2.0 * last - phase : phase;
    const auto i = std::min(static_cast<std::size_t>(at), tremor_.size() - 2);
    const double u = at - static_cast<double>(i);
    const Vec3 step = tremor_[i + 1] - tremor_[i];
    for (std::size_t j = 0; j < kJointCount; ++j) {
      hand.position[j] += tremor_[i] + u * step;
      hand.velocity[j] = (back ? -kRate : kRate) * step;
    }
  }

 private:
  Hand hand_;
  std::vector<Vec3> tremor_;  // of the whole hand, in T [m]
};

/// One hand a frame, as often as kRate, in T.
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

/// The first of the frames in which the palm moves least for kStill.
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

/// The largest distance of a fingertip from the plane of wrist, index and little knuckle [m].
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

std::vector<Vec3> tremor_of(const std::vector<Hand>& hands) {
  const auto count = std::min(static_cast<std::size_t>(kStill * kRate), hands.size());
  const std::size_t first = stillest(hands, count);
  constexpr std::size_t kAround = 20;  // samples of the moving mean on each side: 0.2 s
  std::vector<Vec3> tremor;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i - std::min(i, kAround), to = std::min(count - 1, i + kAround);
    Vec3 mean = Vec3::Zero();
    for (std::size_t j = from; j <= to; ++j)
      mean += hands[first + j].position[kPalm] / static_cast<double>(to - from + 1);
    tremor.push_back(hands[first + i].position[kPalm] - mean);
  }
  return tremor;
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
  std::vector<Vec3> tremor = tremor_of(hands);
  for (Vec3& moved : tremor) moved *= hold.tremor;
  return std::make_unique<HeldHand>(hand, std::move(tremor));
}

std::unique_ptr<HandSource> make_still_hand(HandSource& source, const Hold& hold) {
  HandFrame frame;
  source.sample(0.0, frame);
  to_device(default_tracker_pose(), frame);
  Hand hand = frame.hands.front();
  place(hold, hand);
  to_tracker(hand);
  return std::make_unique<HeldHand>(hand, std::vector<Vec3>());
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
  return std::make_unique<HeldHand>(hand, std::vector<Vec3>());
}

}  // namespace prostm::bench
