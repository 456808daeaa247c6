#include "prostm/emit/played.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "prostm/emit/compensation.hpp"
#include "prostm/emit/drive.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/emit/played_plan.hpp"

namespace prostm {
namespace {

constexpr double kLongestLap = 1.0;  // [s]
constexpr int kLimitedLaps = 8;      // longest laps averaged under the power limit

/// The places on a path at which its focal point is sampled, at equal arc lengths.
struct Lap {
  std::vector<double> wanted;  // intensity at each place, place 0 at the path's first point
  std::vector<double> power;   // Σ intensity² emitted there …
  std::vector<int> times;      // … over this many laps
  // places per sample; above 1 if a lap in step is not a whole number of samples, so that the laps
  // of a loop visit different places
  std::size_t stride = 1;
};

/// Sets how many places a lap has, and the stride. @param loop samples of the plan's loop, or 0.
void set_places(const PlayedPath& path, std::int64_t loop, double sample_rate, Lap& lap) {
  std::int64_t places = 1;
  if (path.laps > 0 && loop > 0) {
    const std::int64_t common = std::gcd(std::int64_t{path.laps}, loop);
    places = loop / common;
    lap.stride = static_cast<std::size_t>(path.laps / common);
  } else if (path.laps > 0) {
    const auto most = static_cast<std::int64_t>(std::ceil(kLongestLap * sample_rate));
    places = std::min<std::int64_t>(std::llround(path.period * sample_rate), most);
  }
  const auto count = static_cast<std::size_t>(places);
  lap.wanted.resize(count);
  lap.power.resize(count);
  lap.times.resize(count);
}

/// Returns the lap with the intensities that the path requests.
Lap lap_of(const LiftedPath& path, const PlayedPath& played, std::int64_t loop,
           const EmitSettings& settings, double sample_rate) {
  Lap lap;
  set_places(played, loop, sample_rate, lap);
  const std::size_t samples = lap.wanted.size();
  for (std::size_t k = 0; k < samples; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(samples);
    bool saturated = false;
    lap.wanted[k] = drive_intensity(point_at(path, path.length * share).pressure,
                                    settings.full_scale_pressure, settings.silent_below, saturated);
  }
  return lap;
}

/// Plays all paths together and sums the power emitted after the first longest lap or loop.
/// @param loop samples of the loop of a plan in step, else 0.
void play(const EmitSettings& settings, double sample_rate, std::int64_t loop,
          std::span<Lap> laps) {
  auto longest = static_cast<std::size_t>(loop);
  double power = 0.0;  // upper bound, as if all peaked at once
  for (const Lap& lap : laps) {
    longest = std::max(longest, lap.wanted.size());
    const double most = *std::max_element(lap.wanted.begin(), lap.wanted.end());
    power += most * most;
  }
  const std::size_t end = longest * (power > settings.power_limit ? 1 + kLimitedLaps : 2);
  const double slew = largest_slew(settings.fade_time, sample_rate);
  std::array<Drive, kMaxPaths> drive{};
  const std::span<Drive> drives(drive.data(), laps.size());
  for (Drive& d : drives) d.max_fall = slew;
  std::array<std::size_t, kMaxPaths> at{};
  for (std::size_t k = 0; k < end; ++k) {
    for (std::size_t f = 0; f < laps.size(); ++f) {
      at[f] += laps[f].stride;
      if (at[f] >= laps[f].wanted.size()) at[f] -= laps[f].wanted.size();
      drives[f].wanted = laps[f].wanted[at[f]];
    }
    limit_drives(drives, slew, settings.power_limit);
    if (k < longest) continue;
    for (std::size_t f = 0; f < laps.size(); ++f) {
      laps[f].power[at[f]] += drives[f].intensity * drives[f].intensity;
      ++laps[f].times[at[f]];
    }
  }
}

/// If the laps of a loop visit different places, gives each place the mean over the places around
/// it that the laps visit.
void average_laps(Lap& lap) {
  if (lap.stride == 1) return;
  const std::size_t n = lap.power.size(), half = lap.stride / 2;
  const double end_weight = lap.stride % 2 == 0 ? 0.5 : 1.0;
  std::vector<double> mean(n);
  for (std::size_t place = 0; place < n; ++place) {
    for (std::size_t i = 0; i <= 2 * half; ++i) {
      const std::size_t from = (place + n + i - half) % n;
      const double weight = i == 0 || i == 2 * half ? end_weight : 1.0;
      mean[place] += weight * lap.power[from] / lap.times[from] / static_cast<double>(lap.stride);
    }
  }
  lap.power = std::move(mean);
  lap.times.assign(n, 1);
}

/// Returns the plan with the factor of (E8) in place of each pressure.
LiftedPlan tilt_factors(LiftedPlan plan, const TargetFrame& frame, double bound) {
  for (LiftedPath& path : plan.paths) std::fill(path.pressure.begin(), path.pressure.end(), 1.0);
  for (LiftedFocus& focus : plan.foci) focus.pressure = 1.0;
  compensate_tilt(plan, frame, bound);
  return plan;
}

/// Emitted intensity² at arc length s, linear between the samples of the lap.
double power_at(const Lap& lap, const LiftedPath& path, double s) {
  const std::size_t n = lap.power.size();
  const double place = path.length > 0.0 ? s / path.length * static_cast<double>(n) : 0.0;
  const auto low = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(low);
  const auto of = [&](std::size_t k) { return lap.power[k % n] / lap.times[k % n]; };
  return (1.0 - share) * of(low) + share * of(low + 1);
}

/// Appends the segments of one path, each with at least as many pressures as samples.
void append(const Lap& lap, const LiftedPath& path, const LiftedPath& factor, std::size_t segments,
            double full_scale, SegmentPressures& out) {
  const std::size_t points = path.p_D.size(), pieces = points / segments;
  for (std::size_t segment = 0; segment < segments; ++segment) {
    // arc length after so many pieces of the segment
    const auto s_at = [&](double piece) {
      const std::size_t i = segment * pieces + static_cast<std::size_t>(piece);
      if (i >= points || pieces == 0) return path.length;
      const double next = i + 1 < points ? path.s[i + 1] : path.length;
      return path.s[i] + (piece - std::floor(piece)) * (next - path.s[i]);
    };
    const double length = s_at(static_cast<double>(pieces)) - s_at(0.0);
    const double samples =
        path.length > 0.0 ? length / path.length * static_cast<double>(lap.power.size()) : 0.0;
    const auto steps = static_cast<std::size_t>(std::ceil(samples)) + 1;
    for (std::size_t k = 0; k <= steps; ++k) {
      const double s = s_at(static_cast<double>(pieces * k) / static_cast<double>(steps));
      out.pressure.push_back(full_scale * power_at(lap, path, s) / point_at(factor, s).pressure);
    }
    out.end.push_back(out.pressure.size());
  }
}

void append_foci(const LiftedPlan& lifted, const LiftedPlan& factors, EmitSettings settings,
                 double sample_rate, SegmentPressures& out) {
  if (lifted.foci.empty()) return;
  settings.foci = static_cast<int>(lifted.foci.size());
  const LoopSamples loop = loop_samples(lifted, settings, sample_rate);
  for (std::size_t f = 0; f < lifted.foci.size(); ++f) {
    double peak = 0.0;
    for (std::size_t i = f; i < loop.sample.size(); i += lifted.foci.size()) {
      peak = std::max(peak, static_cast<double>(loop.sample[i].intensity));
    }
    out.pressure.push_back(settings.full_scale_pressure * peak * peak / factors.foci[f].pressure);
    out.end.push_back(out.pressure.size());
  }
}

}  // namespace

double own_full_scale(double gain, double largest) {
  return std::clamp(gain * largest, 1e-300, 1e300);
}

SegmentPressures played_pressures(const Plan& plan, const TargetFrame& frame, EmitSettings settings,
                                  double sample_rate) {
  validate(settings, sample_rate);
  require_loop(plan.loop);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  const LiftedPlan factors = tilt_factors(lifted, frame, settings.tilt_bound);
  compensate_tilt(lifted, frame, settings.tilt_bound);
  std::vector<Lap> laps;
  const PlayedPlan played = played_plan(lifted, sample_rate);
  const std::int64_t loop = std::llround(played.loop * sample_rate);
  for (std::size_t k = 0; k < lifted.paths.size(); ++k) {
    laps.push_back(lap_of(lifted.paths[k], played.paths[k], loop, settings, sample_rate));
  }
  if (!laps.empty()) play(settings, sample_rate, loop, laps);
  for (Lap& lap : laps) average_laps(lap);

  SegmentPressures out;
  std::size_t k = 0;  // index of the lifted path; paths without points are left out
  for (const FocalPath& path : plan.paths) {
    if (path.points.empty()) continue;
    append(laps[k], lifted.paths[k], factors.paths[k], path.points.size(),
           settings.full_scale_pressure, out);
    ++k;
  }
  append_foci(lifted, factors, settings, sample_rate, out);
  return out;
}

SegmentPressures played_pressures(const Plan& plan, const TargetField& field, EmitSettings settings,
                                  double sample_rate) {
  TargetFrame frame;
  frame.patches.push_back(field);
  return played_pressures(plan, frame, std::move(settings), sample_rate);
}

}  // namespace prostm
