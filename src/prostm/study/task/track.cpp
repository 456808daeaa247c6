#include "prostm/study/task/track.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

/// Rounds to the number of digits that are recorded and presented.
double six_digits(double x) {
  if (x == 0.0) return x;
  const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

}  // namespace

Track::Track(const Protocol& protocol, std::uint64_t seed)
    : settings_(protocol.level),
      base_(protocol.methods.front().settings),
      procedure_(protocol.trials.task->procedure(protocol, seed)),
      most_(static_cast<std::size_t>(protocol.trials.task->tracks(protocol).trials)),
      lowest_(presented(settings_.low)),
      highest_(presented(settings_.high)) {
  settle();
}

/// The level that is presented when a procedure asks for `level`.
double Track::presented(double level) {
  const LevelSettings& s = settings_;
  return set_level(base_, s.setting, std::clamp(six_digits(level), s.low, s.high));
}

void Track::settle() {
  const double x = std::visit([](const auto& p) { return p.level(); }, procedure_);
  level_ = presented(settings_.from_scale(x));
}

/// Counts an answer that asked for a level below (`down`) or above (`up`) the one presented.
void Track::count_at_bound(double level, bool down, bool up) {
  const bool low = down && level <= lowest_, high = up && level >= highest_;
  const bool goes_on = at_bound_.answers > 0 && at_bound_.low == low;
  at_bound_ = low || high ? AtBound{goes_on ? at_bound_.answers + 1 : 1, low} : AtBound{};
}

void Track::answer(bool felt) {
  ++answers_;
  count_at_bound(level_, felt, !felt);
  if (auto* up_down = std::get_if<WeightedUpDown>(&procedure_)) {
    up_down->answer(felt);
  } else {
    std::get<BayesianStaircase>(procedure_).answer(felt, settings_.to_scale(level_));
  }
  settle();
}

void Track::tune(int steps, bool coarse) {
  std::get<Adjustment>(procedure_).tune(steps, coarse);
  settle();
}

void Track::accept(double level) {
  ++answers_;
  count_at_bound(level, true, true);
  std::get<Adjustment>(procedure_).accept(settings_.to_scale(level));
  settle();
}

bool Track::is_done() const {
  return answers_ >= most_ || std::visit([](const auto& p) { return p.is_done(); }, procedure_);
}

std::size_t Track::most() const {
  return most_;
}

double Track::result() const {
  if (const auto* adjustment = std::get_if<Adjustment>(&procedure_))
    return settings_.from_scale(adjustment->result());
  if (const auto* up_down = std::get_if<WeightedUpDown>(&procedure_))
    return settings_.from_scale(up_down->threshold());
  return settings_.from_scale(std::get<BayesianStaircase>(procedure_).threshold());
}

}  // namespace prostm
