#include "prostm/psychophysics/presenter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using experiments::Palm;

constexpr double kHighest = 1000.0;  // highest frequency of the percept [Hz]
constexpr double kLongest = 0.25;    // longest period of the skin's response [s]
constexpr SkinPatch kSweepPatch{20, 72, 2e-3};

/// Returns the place on a way at a share of its length.
Vec2 along(const std::vector<Vec2>& way, double share) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) length += (way[i + 1] - way[i]).norm();
  double left = (share - std::floor(share)) * length;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const double segment = (way[i + 1] - way[i]).norm();
    if (left <= segment)
      return way[i] + (segment > 0.0 ? left / segment : 0.0) * (way[i + 1] - way[i]);
    left -= segment;
  }
  return way.back();
}

/// Returns a lap along an outline: around it, or along a line and back.
experiments::Lap lap_of(const StmLoop& loop) {
  if (loop.outline == Outline::Circle) return experiments::circle_lap(kPi * loop.size);
  if (loop.outline == Outline::Line) return experiments::line_lap(loop.size);
  return [way = corners(loop.outline, loop.size)](double share) { return along(way, share); };
}

/// A place of a course, and the time spent there [s].
struct Stay {
  Vec2 place = Vec2::Zero(), direction = Vec2::UnitX();
  double duration = 0.0;
};

std::vector<Stay> stays_of(const SlowPath& course) {
  std::vector<Stay> out;
  for (int i = 0; i < course.moments; ++i) {
    const double share = (i + 0.5) / course.moments;
    const Vec2 ahead = along(course.way, share + 1e-3) - along(course.way, share - 1e-3);
    out.push_back({along(course.way, share), ahead.normalized(), course.lap / course.moments});
  }
  if (course.pause == 0.0) return out;
  const bool closed = (course.way.front() - course.way.back()).norm() < 1e-9;
  const std::size_t pauses = course.way.size() - (closed ? 1 : 0);
  for (std::size_t i = 0; i < pauses; ++i) {
    const std::size_t next = i + 1 < course.way.size() ? i + 1 : i - 1;
    out.push_back({course.way[i], (course.way[next] - course.way[i]).normalized(), course.pause});
  }
  return out;
}

/// The harmonics P_n of a loop's pressure, (S9), in place of those of the skin's displacement.
class PressureHarmonics : public SkinMotion {
 public:
  /// @param motion the skin's response to the same loop.
  PressureHarmonics(const SkinMotion& motion, const PressureLoop& loop)
      : SkinMotion(motion.patch()) {
    choose_harmonics(loop.period, loop.samples, motion.frequency(motion.harmonics()));
    load(loop);
  }
};

/// Appends all harmonics of a motion.
void append(const SkinMotion& motion, std::vector<std::complex<double>>& out) {
  for (int n = 1; n <= motion.harmonics(); ++n) {
    const auto harmonic = motion.displacement(n);
    out.insert(out.end(), harmonic.begin(), harmonic.end());
  }
}

/// Samples per period: enough for the highest frequency, and for a raised cosine.
int samples_for(double period) {
  return std::max(16, 2 * static_cast<int>(std::ceil(kHighest * period)) + 2);
}

}  // namespace

Vibration vibration_of(const SkinMotion& motion, const PressureLoop& loop) {
  Vibration out;
  out.patch = motion.patch();
  out.period = loop.period;
  out.harmonics = motion.harmonics();
  append(motion, out.displacement);
  append(PressureHarmonics(motion, loop), out.pressure);
  const std::size_t cells = out.patch.size();
  out.mean.assign(cells, 0.0);
  out.largest.assign(cells, 0.0);
  for (std::size_t i = 0; i < loop.pressure.size(); ++i) {
    out.mean[i % cells] += loop.pressure[i] / loop.samples;
    out.largest[i % cells] = std::max(out.largest[i % cells], loop.pressure[i]);
  }
  return out;
}

TransducerArray at_measured_amplitude(TransducerArray array) {
  array.amplitude = array.measured_amplitude;
  array.amplitude_low = std::min(array.amplitude_low, array.amplitude);
  array.amplitude_high = std::max(array.amplitude_high, array.amplitude);
  return array;
}

Presenter::Presenter(const SkinSettings& skin, TransducerArray array)
    : skin_(skin), array_(std::move(array)) {}

Presenter::~Presenter() = default;

const experiments::StmField& Presenter::stm_field(const Palm& palm) {
  auto& field = fields_[{palm.patch.rows, palm.patch.cols, palm.height}];
  if (!field) field = std::make_unique<experiments::StmField>(array_, palm);
  return *field;
}

void Presenter::vibrate(const Palm& palm, double period, int samples,
                        const std::vector<double>& pressure, double duration,
                        const OnMoment& on_moment) {
  auto& response = responses_[{period, samples, palm.patch.rows, palm.patch.cols}];
  if (!response) {
    response = std::make_unique<SkinResponse>(skin_, palm.patch);
    response->prepare(period, samples, kHighest);
  }
  const PressureLoop pressed{period, samples, pressure};
  response->respond(pressed);
  on_moment(vibration_of(*response, pressed), duration);
}

void Presenter::present_am(const AmPoints& am, double height, double duration,
                           const OnMoment& on_moment) {
  if (am.points.empty()) return;
  const Palm palm{.height = height};
  // frequencies of their own: the period of their greatest common divisor
  int common = static_cast<int>(std::lround(am.frequencies.front()));
  for (const double f : am.frequencies) common = std::gcd(common, static_cast<int>(std::lround(f)));
  const double period = 1.0 / common;
  const int samples = samples_for(period);
  std::vector<double> pressure(static_cast<std::size_t>(samples) * palm.cells());
  const auto drive = [&](double f, int k) {
    return 0.5 + 0.5 * std::cos(2.0 * kPi * f * period * k / samples);
  };
  const auto add = [&](const std::vector<double>& at_rest, double f) {
    for (int k = 0; k < samples; ++k) {
      double* to = pressure.data() + static_cast<std::size_t>(k) * palm.cells();
      const double d = drive(f, k);
      for (std::size_t c = 0; c < palm.cells(); ++c) to[c] += d * d * at_rest[c];
    }
  };
  if (am.frequencies.size() == 1) {
    add(experiments::foci_pressure(array_, palm, am.points), am.frequencies.front());
  } else {
    // each focus as it is alone, with its share of the power
    const double share = 1.0 / static_cast<double>(am.points.size());
    for (std::size_t i = 0; i < am.points.size(); ++i) {
      std::vector<double> one = experiments::foci_pressure(array_, palm, {am.points[i]});
      for (double& p : one) p *= share;
      add(one, am.frequencies[i]);
    }
  }
  vibrate(palm, period, samples, pressure, duration, on_moment);
}

void Presenter::present_stm(const StmLoop& loop, double height, const OnMoment& on_moment) {
  const Palm palm{.height = height};
  const Lap lap = lap_of(loop);
  std::vector<Lap> laps;
  for (int i = 0; i < loop.foci; ++i) {
    const double ahead = static_cast<double>(i) / loop.foci;
    laps.push_back([lap, ahead](double share) { return lap(share + ahead); });
  }
  const double period = 1.0 / loop.rate;
  vibrate(palm, period, experiments::StmField::kSamples,
          stm_field(palm).pressure(laps, period, experiments::StmField::kSamples, false), period,
          on_moment);
}

void Presenter::present_disk(const Disk& disk, const OnMoment& on_moment) {
  const Palm palm;
  const double period = disk.frequency > 0.0 ? 1.0 / disk.frequency : kLongest;
  const double on = disk.frequency > 0.0 ? 0.5 * period : disk.pulse;
  // a cell on the edge is covered in part
  constexpr int kParts = 8;
  const double radius = std::sqrt(disk.area / kPi);
  std::vector<double> covered(palm.cells());
  double all = 0.0;
  for (int j = 0; j < palm.patch.rows; ++j) {
    for (int i = 0; i < palm.patch.cols; ++i) {
      double& share = covered[static_cast<std::size_t>(j * palm.patch.cols + i)];
      for (int part = 0; part < kParts * kParts; ++part) {
        const Vec2 in((part % kParts + 0.5) / kParts - 0.5, (part / kParts + 0.5) / kParts - 0.5);
        if ((palm.at(j, i) + palm.patch.cell * in).norm() < radius) share += 1.0;
      }
      all += share;
    }
  }
  const double scale = disk.force / (all * palm.patch.cell * palm.patch.cell);
  const int samples = std::max(64, samples_for(period));
  std::vector<double> pressure(static_cast<std::size_t>(samples) * palm.cells());
  for (int k = 0; k < samples; ++k) {
    // the share of this sample's time in which the pressure is on
    const double share = std::clamp(on * samples / period - k, 0.0, 1.0);
    for (std::size_t c = 0; c < palm.cells(); ++c)
      pressure[static_cast<std::size_t>(k) * palm.cells() + c] = share * scale * covered[c];
  }
  vibrate(palm, period, samples, pressure, period, on_moment);
}

void Presenter::present_course(const SlowPath& course, double height, const OnMoment& on_moment) {
  for (const Stay& stay : stays_of(course)) {
    if (course.frequency > 0.0) {
      present_am({{stay.place}, {course.frequency}}, height, stay.duration, on_moment);
      continue;
    }
    const Palm palm{.height = height};
    const Lap section = experiments::line_lap(course.section);
    const Lap lap = [&](double share) {
      return Vec2(stay.place + section(share).x() * stay.direction);
    };
    const double period = 2.0 * course.section / course.speed;
    constexpr int kSamples = experiments::StmField::kSamples;
    vibrate(palm, period, kSamples, stm_field(palm).pressure({lap}, period, kSamples, false),
            stay.duration, on_moment);
  }
}

void Presenter::present_sweep(const Sweep& sweep, double height, const OnMoment& on_moment) {
  const Palm palm{.patch = kSweepPatch, .height = height};
  const double time = sweep.length / sweep.speed, start = 0.5 * (kLongest - time);
  const Lap lap = [&](double share) {
    const double t = std::clamp(share * kLongest - start, 0.0, time);
    const double turns = sweep.rate * t;
    const double side = std::abs(2.0 * (turns - std::floor(turns)) - 1.0) - 0.5;
    return Vec2(sweep.speed * t - 0.5 * sweep.length, sweep.zigzag * side);
  };
  const int samples = samples_for(kLongest);
  std::vector<double> pressure = stm_field(palm).pressure({lap}, kLongest, samples, false);
  // silent before and after the pass
  for (int k = 0; k < samples; ++k) {
    const double t = k * kLongest / samples;
    if (t >= start && t <= start + time) continue;
    const auto first =
        pressure.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * palm.cells());
    std::fill_n(first, palm.cells(), 0.0);
  }
  vibrate(palm, kLongest, samples, pressure, time, on_moment);
}

void Presenter::present(const PresentedStimulus& stimulus, double height,
                        const OnMoment& on_moment) {
  struct Visitor {
    Presenter& self;
    double height;
    const OnMoment& on_moment;
    void operator()(const AmPoints& s) const { self.present_am(s, height, 1.0, on_moment); }
    void operator()(const StmLoop& s) const { self.present_stm(s, height, on_moment); }
    void operator()(const Disk& s) const { self.present_disk(s, on_moment); }
    void operator()(const SlowPath& s) const { self.present_course(s, height, on_moment); }
    void operator()(const Sweep& s) const { self.present_sweep(s, height, on_moment); }
  };
  std::visit(Visitor{*this, height, on_moment}, stimulus);
}

}  // namespace prostm
