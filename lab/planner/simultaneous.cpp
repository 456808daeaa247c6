#include "planner/simultaneous.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>

#include "planner/contenders.hpp"
#include "planner/sequences.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/emit/detail/path_emitter.hpp"
#include "prostm/fields/fields.hpp"

namespace prostm::bench {
namespace {

constexpr double kInstant = 125e-6;   // time between instants: 0.9 mm along a path [s]
constexpr double kSampleRate = 40e3;  // sample rate of the emission [Hz]
constexpr std::size_t kSamplesPerPlan = 1600, kSamplesPerInstant = 5;
constexpr float kHeard = 0.01F;  // intensity
constexpr int kDraws = 10;       // random starts per plan

using Sounding = boost::container::static_vector<Vec3, kMaxPaths>;

/// A path parametrised by arc length.
class Lap {
 public:
  explicit Lap(const FocalPath& path) : path_(path) {
    double s = 0.0;
    for (std::size_t i = 0; i <= path.points.size(); ++i) {
      at_.push_back(s);
      const std::size_t n = path.points.size();
      s += (path.points[(i + 1) % n] - path.points[i % n]).norm();
    }
  }
  /// Adds the focal point's place at time t, if it is audible.
  void add(double t, double silent_below, Sounding& out) const {
    const double laps = t / path_.period, s = at_.back() * (laps - std::floor(laps));
    const auto after = std::upper_bound(at_.begin() + 1, at_.end() - 1, s);
    const auto i = static_cast<std::size_t>(after - at_.begin()) - 1;
    const std::size_t next = (i + 1) % path_.points.size();
    const double share = (s - at_[i]) / (at_[i + 1] - at_[i]);
    if ((1.0 - share) * path_.pressure[i] + share * path_.pressure[next] < silent_below) return;
    const Vec2 x = (1.0 - share) * path_.points[i] + share * path_.points[next];
    out.push_back(Vec3(x.x(), x.y(), 0.0));
  }

 private:
  const FocalPath& path_;
  boost::container::static_vector<double, kMaxPathPoints + 1> at_;  // arc length of each point [m]
};

/// One line of the tables.
struct Line {
  std::string name;
  LeastDistances distances;
};

void print_lines(const std::string& title, const std::vector<Line>& lines, std::vector<Row>& rows) {
  for (const Line& line : lines) {
    const LeastDistances& d = line.distances;
    fmt::print("{:<32} {:<22} {:>9.2f} {:>9.2f} {:>9.1f} {:>9.1f} {:>9.1f}\n", title, line.name,
               100.0 * d.share_below(kWavelength), 100.0 * d.share_below(2.0 * kWavelength),
               1e3 * d.least(), 1e3 * d.quantile(0.05), 1e3 * d.quantile(0.5));
  }
  Distribution below;
  below.add(100.0 * lines.front().distances.share_below(2.0 * kWavelength));
  rows.push_back({fmt::format("planner/{}/foci within 2 wavelengths", title), "%", below.summary(),
                  lines[1].name, 100.0 * lines[1].distances.share_below(2.0 * kWavelength)});
}

/// Follows plans of single fields from their start.
void measure_plans(Contender& contender, int frames, double seconds, std::vector<Row>& rows) {
  std::vector<Line> lines{{"as planned", {}}, {"random starts", {}}, {"random starts, senses", {}}};
  Random random(1);
  for (const Sequence& sequence : gallery()) {
    contender.begin(sequence.cells);
    for (const int frame : spread(sequence.frames, frames)) {
      const TargetField target = sequence.field(frame);
      Plan plan;
      PlanStats stats;
      contender.plan(target, plan, stats);
      const double silent =
          EmitSettings{}.silent_below * contender.settings().gain * max_pressure(target);
      follow(plan, seconds, silent, lines[0].distances);
      for (int draw = 0; draw < kDraws; ++draw) {
        follow(begun_anywhere(plan, random, false), seconds, silent, lines[1].distances);
        follow(begun_anywhere(plan, random, true), seconds, silent, lines[2].distances);
      }
    }
  }
  print_lines(fmt::format("{}, {:g} ms", contender.name(), 1e3 * seconds), lines, rows);
}

/// Emits a sequence of plans.
class Emission {
 public:
  explicit Emission(const EmitSettings& settings) : emitter_(settings, kSampleRate) {}

  /// Plays the plan until the next is due. @return the distances while it plays.
  LeastDistances play(const Plan& plan, const TargetFrame& targets) {
    LeastDistances out;
    LiftedPlan& draft = emitter_.draft();
    lift(plan, targets, draft);
    draft.id = ++plans_;
    emitter_.submit();
    const auto foci = static_cast<std::size_t>(emitter_.foci());
    std::vector<FocusSample> samples(kSamplesPerPlan * foci);
    emitter_.fill((plans_ - 1) * static_cast<std::int64_t>(kSamplesPerPlan), samples);
    for (std::size_t i = 0; i < samples.size(); i += kSamplesPerInstant * foci) {
      Sounding sounding;
      for (std::size_t f = i; f < i + foci; ++f) {
        if (samples[f].intensity > kHeard) sounding.push_back(samples[f].p_D.cast<double>());
      }
      out.add(std::span<const Vec3>(sounding.data(), sounding.size()));
    }
    return out;
  }

 private:
  PathEmitter emitter_;
  std::int64_t plans_ = 0;
};

/// Measures a second of consecutive warm plans as they are emitted.
void measure_emission(Contender& contender, std::vector<Row>& rows) {
  constexpr int kFrames = 25;
  std::vector<Line> first{{"as planned", {}}, {"random starts, senses", {}}}, all = first;
  Random random(2);
  for (const Sequence& sequence : gallery()) {
    for (const int begin : {0, 40}) {
      contender.begin(sequence.cells);
      EmitSettings settings;
      settings.foci = contender.settings().paths;
      settings.full_scale_pressure =
          contender.settings().gain * max_pressure(sequence.field(begin));
      Emission planned(settings), anywhere(settings);
      for (int frame = begin; frame < begin + kFrames; ++frame) {
        TargetFrame targets;
        targets.patches.push_back(sequence.field(frame));
        Plan plan;
        PlanStats stats;
        contender.plan(targets.patches[0], plan, stats);
        const std::array<LeastDistances, 2> played{
            planned.play(plan, targets),
            anywhere.play(begun_anywhere(plan, random, true), targets)};
        for (std::size_t line = 0; line < played.size(); ++line) {
          all[line].distances.add(played[line]);
          if (frame == begin) first[line].distances.add(played[line]);
        }
      }
    }
  }
  print_lines(contender.name() + ", emitted from silence", first, rows);
  print_lines(contender.name() + ", emitted for 1 s", all, rows);
}

}  // namespace

void LeastDistances::add(std::span<const Vec3> sounding) {
  if (sounding.size() < 2) return;
  double least = std::numeric_limits<double>::max();
  for (std::size_t a = 0; a < sounding.size(); ++a) {
    for (std::size_t b = a + 1; b < sounding.size(); ++b) {
      least = std::min(least, (sounding[a] - sounding[b]).squaredNorm());
    }
  }
  least_.push_back(std::sqrt(least));
}

void LeastDistances::add(const LeastDistances& other) {
  least_.insert(least_.end(), other.least_.begin(), other.least_.end());
}

double LeastDistances::share_below(double distance) const {
  const auto below =
      std::count_if(least_.begin(), least_.end(), [&](double least) { return least < distance; });
  return least_.empty() ? 0.0 : static_cast<double>(below) / static_cast<double>(least_.size());
}

double LeastDistances::quantile(double share) const {
  return prostm::quantile(least_, share);
}

FocalPath begun_at(const FocalPath& path, int first, bool reversed) {
  FocalPath out = path;
  const auto n = static_cast<int>(path.points.size());
  for (int i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>((first + (reversed ? n - i : i)) % n);
    out.points[static_cast<std::size_t>(i)] = path.points[from];
    out.pressure[static_cast<std::size_t>(i)] = path.pressure[from];
  }
  return out;
}

Plan begun_anywhere(const Plan& plan, Random& random, bool senses) {
  Plan out;
  for (const FocalPath& path : plan.paths) {
    const int first = random.below(static_cast<int>(path.points.size()));
    out.paths.push_back(begun_at(path, first, senses && random.below(2) == 1));
  }
  return out;
}

void follow(const Plan& plan, double seconds, double silent_below, LeastDistances& out) {
  std::vector<Lap> laps;
  for (const FocalPath& path : plan.paths) laps.emplace_back(path);
  const auto instants = static_cast<int>(std::lround(seconds / kInstant));
  for (int i = 0; i < instants; ++i) {
    Sounding sounding;
    for (const Lap& lap : laps) lap.add(i * kInstant, silent_below, sounding);
    out.add(std::span<const Vec3>(sounding.data(), sounding.size()));
  }
}

void measure_simultaneous(int frames, std::vector<Row>& rows) {
  fmt::print(
      "\nFocal points at the same time: share of time with two sounding ones nearer than one and\n"
      "two wavelengths ({:.1f} mm), and the least, 5 % and median distance of the nearest two\n"
      "{:<32} {:<22} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      1e3 * kWavelength, "", "", "< 1, %", "< 2, %", "least mm", "5 % mm", "median");
  for (const char* preset : {"fast", "best"}) {
    Contender contender({preset, preset});
    measure_plans(contender, frames, fields::kFrameTime, rows);
    measure_plans(contender, frames, 1.0, rows);
    Contender warm({std::string(preset) + ", warm", preset, 0.0, true});
    measure_emission(warm, rows);
  }
}

}  // namespace prostm::bench
