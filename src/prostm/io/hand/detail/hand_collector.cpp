#include "prostm/io/hand/detail/hand_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "prostm/io/hand/detail/frame_order.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {
namespace {

constexpr double kMostBad = 0.25;              // largest share of bad frames, and of bad hands
constexpr double kMaxRecordingTime = 86400.0;  // [s]
constexpr double kFastest = 1000.0, kSlowest = 0.25;  // rates of trackers [Hz]
constexpr double kUsualRate = 100.0;                  // [Hz]
constexpr double kUsualSpan = 0.0577;  // index to little knuckle of an average hand [m]

struct Unit {
  const char* name;
  double in_si;  // value of the unit in SI
};
constexpr std::array<Unit, 4> kTimeUnits = {
    {{"seconds", 1.0}, {"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};
constexpr std::array<Unit, 4> kLengthUnits = {
    {{"metres", 1.0}, {"centimetres", 1e-2}, {"millimetres", 1e-3}, {"inches", 25.4e-3}}};

/// The unit in which `value` is closest to `usual`, within a factor `within`; null if no unit is
/// close enough.
template <std::size_t n>
const Unit* unit_for(const std::array<Unit, n>& units, double value, double usual, double within) {
  const auto away = [&](const Unit& unit) {
    return std::abs(std::log(value * unit.in_si / usual));
  };
  const auto* const nearest = std::min_element(
      units.begin(), units.end(), [&](const Unit& a, const Unit& b) { return away(a) < away(b); });
  return away(*nearest) <= std::log(within) ? nearest : nullptr;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

HandCollector::HandCollector(std::string name, const HandUnits& units)
    : name_(std::move(name)), units_(units) {
  reading_.file = name_;
}

void HandCollector::add(
    const std::string& where,
    const std::function<HandFrame(const HandFrame* before, HandFaults& faults)>& read) {
  const auto place = static_cast<std::size_t>(reading_.frames++);
  HandFaults faults;
  try {
    Frame frame{read(frames_.empty() ? nullptr : &frames_.back().frame, faults), place, where};
    reading_.hands += static_cast<std::int64_t>(frame.frame.hands.size()) + faults.hands();
    frames_.push_back(std::move(frame));
  } catch (const HandError& error) {
    faults.add(error.fault(), error.what());
  } catch (const InputError& error) {
    faults.add(HandFault::Unreadable, error.what());
  }
  reading_.faults.add(faults);
}

void HandCollector::note_span(double span) {
  if (std::isfinite(span) && span > 0.0) spans_.push_back(span);
}

void HandCollector::note_rate(double rate) {
  if (rate >= kSlowest && rate <= kFastest) rates_.push_back(rate);
}

/// Drops frame i because of its time.
void HandCollector::drop(std::size_t i) {
  const Frame& frame = frames_[i];
  reading_.faults.add(
      HandFault::Order,
      fmt::format("{}, {}: its time, {:.6f} s after that of the first frame, is inconsistent with "
                  "those of the frames around it; time must increase",
                  name_, frame.where, frame.frame.time - frames_.front().frame.time));
}

/// Drops frames with times that do not increase, and a first or last frame far from all others.
void HandCollector::drop_astray() {
  std::vector<FrameTime> times;
  for (const Frame& frame : frames_) times.push_back({frame.frame.time, frame.place});
  std::vector<std::size_t> kept = frames_in_order(times);

  std::vector<double> kept_times;
  for (const std::size_t i : kept) kept_times.push_back(times[i].time);
  const double far = std::max(1.0, 20.0 * usual_interval(kept_times));  // [s]
  const auto alone = [&](std::size_t i, std::size_t next) {
    return !frames_[i].frame.hands.empty() && std::abs(times[next].time - times[i].time) > far;
  };
  if (kept.size() > 2 && alone(kept.back(), kept[kept.size() - 2])) kept.pop_back();
  if (kept.size() > 2 && alone(kept[0], kept[1])) kept.erase(kept.begin());

  if (kept.size() == frames_.size()) return;
  std::vector<Frame> left;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!std::binary_search(kept.begin(), kept.end(), i)) drop(i);
  }
  for (const std::size_t i : kept) left.push_back(std::move(frames_[i]));
  frames_ = std::move(left);
}

void HandCollector::check_rate() const {
  std::vector<double> times;
  for (const Frame& frame : frames_) times.push_back(frame.frame.time);
  const double interval = usual_interval(times);
  if (!(interval > 0.0)) return;
  const double rate = 1.0 / interval, said = rates_.empty() ? 0.0 : median(rates_);
  // recordings may have fewer frames than the tracker made, but not more
  const bool fast = rate > kFastest || (said > 0.0 && rate > 3.0 * said);
  if (!fast && rate >= kSlowest) return;
  const Unit* unit =
      unit_for(kTimeUnits, interval * units_.second, 1.0 / (said > 0.0 ? said : kUsualRate), 12.0);
  const bool other = unit != nullptr && std::string_view(unit->name) != units_.time_unit;
  if (!fast && !other) return;  // slow recordings may have been written by hand
  throw InputError(fmt::format(
      "{}: by \"{}\" it has {:.4g} frames per second, which is not possible for a tracker{}; {}",
      name_, units_.stamp, rate,
      said > 0.0 ? fmt::format(" (the tracker says {:.4g})", said) : std::string(),
      other ? fmt::format("the times seem to be in {}; they must be in {}", unit->name,
                          units_.time_unit)
            : fmt::format("the times must be in {}", units_.time_unit)));
}

std::string HandCollector::guess_of_lengths() const {
  if (spans_.empty()) return {};
  const Unit* unit = unit_for(kLengthUnits, median(spans_), kUsualSpan, 2.0);
  if (unit == nullptr || std::string_view(unit->name) == units_.length_unit) return {};
  return fmt::format("; positions seem to be in {}, they must be in {}", unit->name,
                     units_.length_unit);
}

void HandCollector::check_shares() const {
  const HandFaults& faults = reading_.faults;
  const auto many = [](std::int64_t bad, std::int64_t all) {
    return static_cast<double>(bad) > kMostBad * static_cast<double>(all);
  };
  if (!many(faults.frames(), reading_.frames) && !many(faults.hands(), reading_.hands)) return;
  throw InputError(fmt::format(
      "{}{} (dropped: {} of {} frames and {} of {} hands, for {}; at most a quarter may "
      "be)",
      faults.first, guess_of_lengths(), faults.frames(), reading_.frames, faults.hands(),
      reading_.hands, causes_of(faults)));
}

HandRecording HandCollector::finish() {
  if (reading_.frames == 0)
    throw InputError(name_ + ": holds 0 frames; a recording must have at least 1");
  if (!frames_.empty()) {
    drop_astray();
    check_rate();
  }
  check_shares();
  HandRecording recording;
  std::int64_t z_up = 0;
  const double start = frames_.front().frame.time;
  if (frames_.back().frame.time - start > kMaxRecordingTime) {
    throw InputError(
        fmt::format("{}, {}: is more than a day after the first frame; {} must be in {}", name_,
                    frames_.back().where, units_.stamp, units_.time_unit));
  }
  for (Frame& frame : frames_) {
    frame.frame.time -= start;
    for (const Hand& hand : frame.frame.hands) z_up += looks_z_up(hand) ? 1 : 0;
    recording.frames.push_back(std::move(frame.frame));
  }
  if (2 * z_up > reading_.hands) {
    reading_.doubt =
        "the hands lie as if z were up, before the tracker and not above it; T has y up and z to "
        "the user, and --tracker tells how T lies";
  }
  recording.reading = std::move(reading_);
  return recording;
}

}  // namespace prostm
