#include "prostm/experiments/stimuli.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "prostm/acoustics/array/transducer.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/units.hpp"

namespace prostm::experiments {
namespace {

/// Computes G from every transducer to every cell, (A1).
Eigen::MatrixXcd propagation_to_palm(const TransducerArray& array, const Palm& palm) {
  const Medium air;
  const Wave sound = wave(array, air);
  Eigen::MatrixXcd g(static_cast<Eigen::Index>(palm.cells()),
                     static_cast<Eigen::Index>(array.position.size()));
  for (int j = 0; j < palm.patch.rows; ++j) {
    for (int i = 0; i < palm.patch.cols; ++i) {
      const Vec2 x = palm.at(j, i);
      for (std::size_t n = 0; n < array.position.size(); ++n) {
        g(j * palm.patch.cols + i, static_cast<Eigen::Index>(n)) =
            propagate(array, sound, n, Vec3(x.x(), x.y(), palm.height));
      }
    }
  }
  return g;
}

}  // namespace

Lap circle_lap(double circumference) {
  const double radius = circumference / (2.0 * kPi);
  return [radius](double share) {
    return Vec2(radius * std::cos(2.0 * kPi * share), radius * std::sin(2.0 * kPi * share));
  };
}

Lap square_lap(double side) {
  return [side](double share) {
    const double along = 4.0 * (share - std::floor(share));
    const int edge = static_cast<int>(along);
    const double s = side * (along - edge - 0.5), half = 0.5 * side;
    switch (edge) {
      case 0:
        return Vec2(s, -half);
      case 1:
        return Vec2(half, s);
      case 2:
        return Vec2(-s, half);
      default:
        return Vec2(-half, -s);
    }
  };
}

Lap line_lap(double length) {
  return [length](double share) {
    const double along = share - std::floor(share);
    return Vec2(length * (along < 0.5 ? 2.0 * along - 0.5 : 1.5 - 2.0 * along), 0.0);
  };
}

StmField::StmField(const TransducerArray& array, const Palm& palm)
    : array_(array), palm_(palm), to_palm_(propagation_to_palm(array, palm)) {}

/// The drives of focal points that move together.
class StmField::Drives {
 public:
  Drives(const TransducerArray& array, double height) : array_(array), height_(height) {}

  /// Computes the drives for these places, one for each transducer.
  void at(const std::vector<Lap>& laps, double share, std::vector<std::complex<double>>& out) {
    std::vector<Vec3> foci;
    for (const Lap& lap : laps) {
      const Vec2 x = lap(share);
      foci.emplace_back(x.x(), x.y(), height_);
    }
    if (foci.size() == 1) {
      phases_.resize(out.size());
      focus_phases(array_, Medium{}, foci.front(), phases_);
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::polar(1.0, phases_[i]);
      return;
    }
    const Propagation g = propagation_to(array_, Medium{}, foci);
    // a target beyond the array's output, so that the level is as high as possible
    const FocusSolution solution =
        solve_foci(g, Eigen::VectorXd::Constant(g.rows(), 1e5), {}, start_);
    start_ = solution.pressure.array().arg();
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = solution.drive[static_cast<Eigen::Index>(i)];
  }

 private:
  const TransducerArray& array_;
  double height_;
  std::vector<double> phases_;
  Eigen::VectorXd start_;  // phases of the previous foci
};

std::vector<double> StmField::pressure(const std::vector<Lap>& laps, double period, int samples,
                                       bool memoryless) const {
  const std::size_t count = array_.position.size();
  const int per_sample = static_cast<int>(std::ceil(40e3 * period / samples));
  const int in_all = samples * per_sample;
  TransducerSettings settings;
  settings.memoryless = memoryless;
  settings.sample_rate = in_all / period;
  TransducerDynamics dynamics(settings, count);

  const auto output = [&] {
    return Eigen::Map<const Eigen::VectorXcd>(dynamics.output().data(),
                                              static_cast<Eigen::Index>(count));
  };
  Drives drives(array_, palm_.height);
  std::vector<std::complex<double>> drive(count);
  Eigen::MatrixXcd outputs(static_cast<Eigen::Index>(count), samples);
  // the drives before the lap, until the initial state has decayed: 12 time constants
  const double fade = memoryless ? 0.0 : 12.0 * time_constant(settings);
  const int before = static_cast<int>(std::ceil(fade * settings.sample_rate));
  for (int n = -before; n < in_all; ++n) {
    // the output at this moment results from the drives up to it
    if (n >= 0 && n % per_sample == 0) outputs.col(n / per_sample) = output();
    const int in_lap = (n % in_all + in_all) % in_all;
    drives.at(laps, (in_lap + 0.5) / in_all, drive);
    dynamics.step(drive);
  }
  // without a delay, the output at the first moment is that of the last drive
  if (memoryless) outputs.col(0) = output();

  const Eigen::MatrixXcd field = to_palm_ * outputs;
  const Medium air;
  std::vector<double> pressure;
  pressure.reserve(palm_.cells() * static_cast<std::size_t>(samples));
  for (Eigen::Index k = 0; k < samples; ++k) {
    for (Eigen::Index c = 0; c < field.rows(); ++c)
      pressure.push_back(radiation_pressure(std::abs(field(c, k)), air));
  }
  return pressure;
}

std::vector<double> foci_pressure(const TransducerArray& array, const Palm& palm,
                                  const std::vector<Vec2>& foci) {
  const Medium air;
  std::vector<Vec3> places;
  for (const Vec2& x : foci) places.emplace_back(x.x(), x.y(), palm.height);
  const Propagation g = propagation_to(array, air, places);
  // a target beyond the array's output, so that the level is as high as possible
  const Eigen::VectorXd target = Eigen::VectorXd::Constant(g.rows(), 1e5);
  FocusSettings settings;
  settings.method = FocusMethod::LevenbergMarquardt;
  const FocusSolution solution = solve_foci(g, target, settings);
  const Eigen::VectorXcd field = propagation_to_palm(array, palm) * solution.drive;
  std::vector<double> pressure;
  for (Eigen::Index c = 0; c < field.size(); ++c) {
    pressure.push_back(radiation_pressure(std::abs(field[c]), air));
  }
  return pressure;
}

}  // namespace prostm::experiments
