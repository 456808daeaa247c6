#include "prostm/track/calibration_guide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace prostm {
namespace {

constexpr double kTakeTime = 0.5;       // a mark is observed for this long [s]
constexpr std::size_t kLeastSeen = 5;   // least frames in that time
constexpr double kMostSpread = 0.005;   // largest rms spread of a resting finger [m]
constexpr std::size_t kLeastMarks = 3;  // least marks for a pose

}  // namespace

CalibrationGuide::CalibrationGuide(std::span<const Vec3> transducers) {
  if (transducers.empty())
    throw std::invalid_argument("the array has 0 transducers; a calibration needs its outline");
  Vec3 low = transducers.front(), high = low;
  for (const Vec3& p : transducers) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  marks_ = {{"the front left corner", {low.x(), low.y(), high.z()}},
            {"the front right corner", {high.x(), low.y(), high.z()}},
            {"the back right corner", {high.x(), high.y(), high.z()}},
            {"the back left corner", {low.x(), high.y(), high.z()}}};
  pairs_.resize(marks_.size());
}

void CalibrationGuide::watch(double time, const HandFrame& hands_T) {
  hands_ = hands_T.hands.size();
  if (hands_ != 1) {
    seen_.clear();
    return;
  }
  std::erase_if(seen_, [&](const Seen& seen) { return time - seen.time > kTakeTime; });
  if (!seen_.empty() && !(time > seen_.back().time)) return;
  const Hand& hand = hands_T.hands.front();
  seen_.push_back({time, hand.position[kIndexTip], hand.radius[kIndexTip]});
}

std::string CalibrationGuide::take(int mark) {
  if (mark < 0 || static_cast<std::size_t>(mark) >= marks_.size())
    return fmt::format("there is no mark {}; the marks are 0 to {}", mark, marks_.size() - 1);
  const auto index = static_cast<std::size_t>(mark);
  if (hands_ > 1) return "two hands are in sight; show only one";
  if (hands_ == 0 || seen_.size() < kLeastSeen)
    return "no hand has been in sight for long enough; hold a finger still on the mark";
  Vec3 mean = Vec3::Zero();
  double radius = 0.0, squares = 0.0;
  const double share = 1.0 / static_cast<double>(seen_.size());
  for (const Seen& seen : seen_) {
    mean += share * seen.p_T;
    radius += share * seen.radius;
  }
  for (const Seen& seen : seen_) squares += share * (seen.p_T - mean).squaredNorm();
  const double spread = std::sqrt(squares);
  if (spread > kMostSpread) {
    return fmt::format("the finger moved by {:.1f} mm; hold it still for half a second",
                       spread * 1e3);
  }
  marks_[index].taken = true;
  marks_[index].spread = spread;
  pairs_[index] = {mean, marks_[index].p_D + radius * Vec3::UnitZ()};
  result_.reset();
  return {};
}

std::string CalibrationGuide::solve() {
  std::vector<PointPair> taken;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    if (marks_[i].taken) taken.push_back(pairs_[i]);
  }
  try {
    result_ = calibrate(taken);
  } catch (const std::invalid_argument& error) {
    result_.reset();
    return error.what();
  }
  return {};
}

std::string CalibrationGuide::sentence() const {
  if (result_) {
    return fmt::format("Residual error of the pose: {:.1f} mm rms, {:.1f} mm at the worst mark.",
                       result_->rms * 1e3, result_->largest * 1e3);
  }
  const auto next = std::find_if(marks_.begin(), marks_.end(),
                                 [](const CalibrationMark& mark) { return !mark.taken; });
  if (next != marks_.end()) {
    const auto taken = std::count_if(marks_.begin(), marks_.end(),
                                     [](const CalibrationMark& mark) { return mark.taken; });
    return fmt::format("Touch {} with the tip of an index finger, hold still, and take it{}.",
                       next->name,
                       static_cast<std::size_t>(taken) >= kLeastMarks ? ", or solve" : "");
  }
  return "All marks are taken: solve.";
}

}  // namespace prostm
