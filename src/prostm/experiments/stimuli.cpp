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

std::vector<double> StmField::pressure(const Lap& lap, double period, bool memoryless) const {
  const std::size_t count = array_.position.size();
  const int per_sample = static_cast<int>(std::ceil(40e3 * period / kSamples));
  TransducerSettings settings;
  settings.memoryless = memoryless;
  settings.sample_rate = per_sample * kSamples / period;
  TransducerDynamics dynamics(settings, count);

  const Medium air;
  std::vector<double> phases(count);
  std::vector<std::complex<double>> drives(count);
  Eigen::MatrixXcd outputs(static_cast<Eigen::Index>(count), kSamples);
  // initial laps, until the initial state has decayed: 12 time constants
  const double fade = 12.0 * time_constant(settings);
  const int laps_before = memoryless ? 0 : static_cast<int>(std::ceil(fade / period));
  for (int n = 0; n < (laps_before + 1) * kSamples * per_sample; ++n) {
    const int in_lap = n % (kSamples * per_sample);
    if (n >= laps_before * kSamples * per_sample && n % per_sample == 0) {
      // the output at this moment results from the drives up to it
      outputs.col(in_lap / per_sample) = Eigen::Map<const Eigen::VectorXcd>(
          dynamics.output().data(), static_cast<Eigen::Index>(count));
    }
    const Vec2 x = lap((in_lap + 0.5) / (kSamples * per_sample));
    focus_phases(array_, air, Vec3(x.x(), x.y(), palm_.height), phases);
    for (std::size_t i = 0; i < count; ++i) drives[i] = std::polar(1.0, phases[i]);
    dynamics.step(drives);
  }
  if (memoryless) {  // the output at the first moment is that of the last drive
    outputs.col(0) = Eigen::Map<const Eigen::VectorXcd>(dynamics.output().data(),
                                                        static_cast<Eigen::Index>(count));
  }

  const Eigen::MatrixXcd field = to_palm_ * outputs;
  std::vector<double> pressure;
  pressure.reserve(palm_.cells() * kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    for (Eigen::Index c = 0; c < field.rows(); ++c) {
      pressure.push_back(radiation_pressure(std::abs(field(c, k)), air));
    }
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
