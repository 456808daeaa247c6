#pragma once
/// Paths and checks shared by the emission's tests.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/detail/path_emitter.hpp"

namespace prostm::test {

/// Returns a closed path through points.
inline LiftedPath closed_path(std::span<const Vec3> points, double pressure, double speed = 7.0) {
  LiftedPath path;
  path.speed = speed;
  for (const Vec3& p : points) {
    path.p_D.push_back(p);
    path.pressure.push_back(pressure);
  }
  measure(path);
  return path;
}

/// Returns a regular polygon with `sides` sides and the given perimeter [m].
inline LiftedPath ring(const Vec3& centre, double length, int sides, double pressure,
                       double speed = 7.0) {
  std::vector<Vec3> points;
  const double radius = length / sides / (2.0 * std::sin(kPi / sides));
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * kPi * i / sides;
    points.push_back(centre + radius * Vec3(std::cos(a), std::sin(a), 0.0));
  }
  return closed_path(points, pressure, speed);
}

inline LiftedPath point(const Vec3& p, double pressure) {
  return closed_path(std::vector<Vec3>{p}, pressure);
}

/// Checks the guarantees of PathEmitter sample by sample.
class Watch {
 public:
  Watch(int foci, double sample_rate, double power_limit)
      : last_(static_cast<std::size_t>(foci)),
        max_move_(8.0 / sample_rate),
        power_limit_(power_limit) {}

  void look(std::span<const FocusSample> block) {
    for (std::size_t i = 0; i < block.size(); i += last_.size())
      look_at(block.subspan(i, last_.size()));
  }

  // largest values so far
  double step = 0.0;  ///< [m] between samples above 1 %
  double slew = 0.0;  ///< change of intensity between samples
  double power = 0.0;
  double highest = 0.0, lowest = 0.0;
  bool finite = true;

  bool holds() const {
    return finite && step <= max_move_ && slew <= 1.0 / 40.0 + 1e-6 &&
           power <= power_limit_ + 1e-5 && highest <= 1.0 && lowest >= 0.0;
  }

 private:
  void look_at(std::span<const FocusSample> sample) {
    double sum = 0.0;
    for (std::size_t f = 0; f < sample.size(); ++f) {
      const FocusSample& s = sample[f];
      finite = finite && s.p_D.allFinite() && std::isfinite(s.intensity);
      if (!finite) return;
      const double intensity = static_cast<double>(s.intensity);
      if (started_) {
        const double before = static_cast<double>(last_[f].intensity);
        slew = std::max(slew, std::abs(intensity - before));
        if (std::max(intensity, before) > 0.01) {
          step = std::max(step, (s.p_D.cast<double>() - last_[f].p_D.cast<double>()).norm());
        }
      }
      sum += intensity * intensity;
      highest = std::max(highest, intensity);
      lowest = std::min(lowest, intensity);
      last_[f] = s;
    }
    power = std::max(power, sum);
    started_ = true;
  }

  std::vector<FocusSample> last_;
  double max_move_, power_limit_;
  bool started_ = false;
};

/// Pulls an emitter block by block, like a device.
class Player {
 public:
  static constexpr std::size_t kBlock = 40;

  explicit Player(const EmitSettings& settings, double sample_rate = 40e3)
      : emitter(settings, sample_rate),
        watch(settings.foci, sample_rate, settings.power_limit),
        block_(kBlock * static_cast<std::size_t>(settings.foci)) {}

  /// Pulls n blocks. @return the samples of the last block.
  std::span<const FocusSample> play(int n) {
    for (int i = 0; i < n; ++i) {
      emitter.fill(next_, block_);
      next_ += static_cast<std::int64_t>(kBlock);
      watch.look(block_);
      if (keep) kept.insert(kept.end(), block_.begin(), block_.end());
    }
    return block_;
  }

  void submit(std::initializer_list<LiftedPath> paths, std::int64_t id = 1) {
    LiftedPlan& plan = emitter.draft();
    plan.paths.clear();
    for (const LiftedPath& path : paths) plan.paths.push_back(path);
    plan.id = id;
    emitter.submit();
  }

  std::int64_t samples() const { return next_; }

  PathEmitter emitter;
  Watch watch;
  bool keep = false;              ///< keep all samples …
  std::vector<FocusSample> kept;  ///< … here

 private:
  std::vector<FocusSample> block_;
  std::int64_t next_ = 0;
};

inline EmitSettings settings_for(int foci, double full_scale = 1.0) {
  EmitSettings settings;
  settings.foci = foci;
  settings.full_scale_pressure = full_scale;
  return settings;
}

}  // namespace prostm::test
