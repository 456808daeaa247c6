#include "prostm/emit/loop_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "prostm/emit/detail/focus_emitter.hpp"
#include "prostm/emit/drive.hpp"

namespace prostm {
namespace {

constexpr double kSmallStretch = 0.01;
constexpr int kLongestLaps = 8;      // a loop is at most so many longest laps
constexpr double kLongestLap = 1.0;  // [s]

int laps_in(int samples, double lap) {
  return lap > 0.0 ? std::max(1, static_cast<int>(std::lround(samples / lap))) : 0;
}

double stretch_in(int samples, double lap) {
  return lap > 0.0 ? samples / (laps_in(samples, lap) * lap) - 1.0 : 0.0;
}

int loop_length(const std::vector<double>& laps) {
  const double longest = *std::max_element(laps.begin(), laps.end());
  const int least =
      std::max(1, static_cast<int>(std::ceil(longest / kLoopUnit - 1e-6))) * kLoopUnit;
  int best = least;
  double least_stretch = 1.0;
  for (int samples = least; samples <= kLongestLaps * least; samples += kLoopUnit) {
    double worst = 0.0;
    for (const double lap : laps) worst = std::max(worst, std::abs(stretch_in(samples, lap)));
    if (worst < least_stretch) {
      best = samples;
      least_stretch = worst;
    }
    if (worst <= kSmallStretch) break;
  }
  return best;
}

double longest_of(const PlayedPlan& played) {
  double longest = 0.0;
  for (const PlayedPath& path : played.paths) longest = std::max(longest, path.period);
  return longest;
}

void check(const LiftedPlan& plan, const PlayedPlan& played, const EmitSettings& settings) {
  const std::size_t count = plan.paths.size() + plan.foci.size();
  if (count < 1 || count > static_cast<std::size_t>(settings.foci)) {
    throw std::invalid_argument("a plan has " + std::to_string(count) +
                                (plan.foci.empty() ? " paths" : " foci") + "; a loop takes 1 to " +
                                std::to_string(settings.foci) + ", the number of focal points");
  }
  if (longest_of(played) > kLongestLap) {
    throw std::invalid_argument(
        "a lap of a path takes more than 1 s; make the path shorter or its focal point faster");
  }
}

/// Whole periods of the modulation.
LoopSamples loop_of_foci(const LiftedPlan& plan, EmitSettings settings, double sample_rate) {
  settings.foci = static_cast<int>(plan.foci.size());
  settings.stall_time = 1.0;  // longer than any loop
  FocusEmitter emitter(settings, sample_rate);
  emitter.draft() = plan;
  emitter.submit();
  LoopSamples loop;
  loop.foci = settings.foci;
  loop.samples = std::lcm(emitter.period(), kLoopUnit);
  loop.sample_rate = sample_rate;
  loop.sample.resize(plan.foci.size() * static_cast<std::size_t>(loop.samples));
  loop.laps.assign(plan.foci.size(), 0);
  loop.stretch.assign(plan.foci.size(), 0.0);
  // after one period all are audible, whatever their phases
  const std::int64_t period = emitter.period();
  std::vector<FocusSample> begin(plan.foci.size() * static_cast<std::size_t>(period));
  emitter.fill(0, begin);
  emitter.fill(period, loop.sample);
  return loop;
}

/// Sets the loop's length and laps for a plan whose paths have periods of their own.
void set_laps(LoopSamples& loop) {
  std::vector<double> laps;
  for (const PlayedPath& path : loop.played.paths) laps.push_back(path.period * loop.sample_rate);
  loop.samples = loop_length(laps);
  for (std::size_t f = 0; f < laps.size(); ++f) {
    const int count = laps_in(loop.samples, laps[f]);
    const double planned = count * loop.played.paths[f].planned_period * loop.sample_rate;
    loop.laps.push_back(count);
    loop.stretch.push_back(count > 0 ? loop.samples / planned - 1.0 : 0.0);
  }
}

/// The same for a plan in step.
void set_laps_in_step(LoopSamples& loop) {
  const double samples = loop.played.loop * loop.sample_rate;
  loop.samples = kLoopUnit * std::max(1, static_cast<int>(std::lround(samples / kLoopUnit)));
  for (const PlayedPath& path : loop.played.paths) {
    loop.laps.push_back(path.laps);
    loop.stretch.push_back(path.laps > 0 ? loop.samples / samples - 1.0 : 0.0);
  }
}

/// Computes one sample of every focal point: its position, and the intensity its path requests.
void advance(const LiftedPlan& plan, const EmitSettings& settings, LoopSamples& loop, int k,
             std::span<Drive> drives) {
  bool saturated = false;
  for (std::size_t f = 0; f < drives.size(); ++f) {
    const LiftedPath& path = plan.paths[f];
    FocusSample& out = loop.sample[static_cast<std::size_t>(k) * drives.size() + f];
    if (path.p_D.empty()) continue;
    const double share = static_cast<double>(k) * loop.laps[f] / loop.samples;
    const PathPoint point = point_at(path, path.length * (share - std::floor(share)));
    out.p_D = point.p_D.cast<float>();
    drives[f].wanted = drive_intensity(point.pressure, settings.full_scale_pressure,
                                       settings.silent_below, saturated);
  }
}

}  // namespace

double LoopSamples::largest_stretch() const {
  double largest = 0.0;
  for (const double s : stretch) largest = std::max(largest, std::abs(s));
  return largest;
}

double longest_lap(const LiftedPlan& plan, double sample_rate) {
  return longest_of(played_plan(plan, sample_rate));
}

LoopSamples loop_samples(const LiftedPlan& plan, const EmitSettings& settings, double sample_rate) {
  validate(settings, sample_rate);
  require_loop(plan.loop);
  LoopSamples loop;
  loop.played = played_plan(plan, sample_rate);
  check(plan, loop.played, settings);
  if (!plan.foci.empty()) return loop_of_foci(plan, settings, sample_rate);
  loop.foci = static_cast<int>(plan.paths.size());
  loop.sample_rate = sample_rate;
  if (plan.loop > 0.0) {
    set_laps_in_step(loop);
  } else {
    set_laps(loop);
  }
  loop.sample.resize(plan.paths.size() * static_cast<std::size_t>(loop.samples));

  // two loops, so that the second one starts with the intensities that it ends with
  const double slew = largest_slew(settings.fade_time, sample_rate);
  std::array<Drive, kMaxPaths> drive{};
  const std::span<Drive> drives(drive.data(), plan.paths.size());
  for (Drive& d : drives) d.max_fall = slew;
  for (int k = 0; k < 2 * loop.samples; ++k) {
    const int sample = k % loop.samples;
    advance(plan, settings, loop, sample, drives);
    limit_drives(drives, slew, settings.power_limit);
    for (std::size_t f = 0; f < drives.size(); ++f) {
      loop.sample[static_cast<std::size_t>(sample) * drives.size() + f].intensity =
          static_cast<float>(drives[f].intensity);
    }
  }
  return loop;
}

}  // namespace prostm
