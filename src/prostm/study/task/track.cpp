#include "prostm/study/task/track.hpp"

#include <cmath>

namespace prostm {
namespace {

constexpr double kSlope = 20.0;   // of bayes, over the range
constexpr double kSpread = 0.25;  // of its prior, of the range
constexpr double kLapses = 0.02;
constexpr double kAway = 0.25;   // from the middle that adjustments begin, of the range
constexpr double kCoarse = 4.0;  // steps of a coarse one

using Procedure = std::variant<WeightedUpDown, BayesianStaircase, Adjustment>;

Procedure procedure_of(const Protocol& protocol, std::uint64_t seed) {
  const LevelSettings& s = protocol.level;
  const LevelRange range = s.range();
  const double width = range.high - range.low;
  if (protocol.trials.task == StudyTask::Adjustment) {
    const double step = s.step_on_scale();
    return Adjustment({.coarse = std::min(kCoarse * step, width),
                       .fine = step,
                       .repeats = protocol.trials.repeats,
                       .away = kAway * width,
                       .seed = seed,
                       .range = range});
  }
  if (s.procedure == Staircase::UpDown) {
    return WeightedUpDown({.start = s.to_scale(s.start),
                           .step = s.step_on_scale(),
                           .target = s.share,
                           .coarse = s.coarse,
                           .reversals = s.reversals,
                           .range = range});
  }
  const double slope = s.slope > 0.0 ? s.slope : kSlope / width;
  return BayesianStaircase({.shape = {.slope = slope,
                                      .guess = has_right_answers(protocol) ? 0.5 : 0.0,
                                      .lapse = kLapses},
                            .expected = s.to_scale(s.start),
                            .spread = kSpread * width,
                            .trials = s.trials,
                            .range = range});
}

/// So many digits are written down, and are presented.
double six_digits(double x) {
  if (x == 0.0) return x;
  const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

}  // namespace

int answers_at_bound(const Protocol& protocol) {
  return protocol.trials.task == StudyTask::Adjustment ? 1 : 3;
}

bool has_right_answers(const Protocol& protocol) {
  return protocol.trials.task == StudyTask::ForcedChoice && !protocol.standard;
}

Track::Track(const Protocol& protocol, std::uint64_t seed)
    : settings_(protocol.level),
      base_(protocol.methods.front().settings),
      procedure_(procedure_of(protocol, seed)),
      most_(static_cast<std::size_t>(protocol.trials.task == StudyTask::Adjustment
                                         ? protocol.trials.repeats
                                         : protocol.level.trials)),
      lowest_(presented(settings_.low)),
      highest_(presented(settings_.high)) {
  settle();
}

/// The level that is presented for one that a procedure asks for.
double Track::presented(double level) {
  const LevelSettings& s = settings_;
  return set_level(base_, s.setting, std::clamp(six_digits(level), s.low, s.high));
}

void Track::settle() {
  const double x = std::visit([](const auto& p) { return p.level(); }, procedure_);
  level_ = presented(settings_.from_scale(x));
}

/// Counts an answer that asked for a level below (above) the one that was presented.
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
