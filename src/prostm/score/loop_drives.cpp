#include "prostm/score/loop_drives.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <vector>

#include "prostm/core/require.hpp"
#include "prostm/score/detail/sample_solver.hpp"

namespace prostm {
namespace {

using Eigen::Index;

constexpr int kWarmUp = 64;     // samples solved before the first, for the phases to settle
constexpr double kFull = 0.99;  // |q| above which a drive counts as full

Sounding sounding(const LoopSamples& loop, int k) {
  const auto foci = static_cast<std::size_t>(loop.foci);
  return Sounding(std::span(loop.sample).subspan(static_cast<std::size_t>(k) * foci, foci));
}

/// Computes the drives at full output, and the acoustic pressure per intensity that each sample
/// then reaches [Pa]. @return false if `progress` stopped it.
bool solve_all(const TransducerArray& array, const Medium& medium, const LoopSamples& loop,
               const FocusSettings& settings, const std::function<bool(int, int)>& progress,
               Eigen::MatrixXcd& drives, std::vector<double>& reached, LoopDriveResult& out) {
  SampleSolver solver(array, medium, settings, loop.foci);
  const int all = loop.samples, warm_up = std::min(kWarmUp, all);
  for (int k = -warm_up; k < all; ++k) {
    if (!progress(k + warm_up, all + warm_up)) return false;
    const Sounding s = sounding(loop, (k + all) % all);
    if (s.p_D.empty()) continue;
    const FocusSolution solution = solver.solve(s);
    if (k < 0) continue;
    drives.col(k) = solution.drive;
    reached[static_cast<std::size_t>(k)] = SampleSolver::reached(solution);
    out.merged += s.merged;
    out.worst_focus_error = std::max(out.worst_focus_error, solver.errors().cwiseAbs().maxCoeff());
  }
  return true;
}

/// Scales all samples to one full scale, and counts those that do not reach it.
void scale(const std::vector<double>& reached, double full_scale, Eigen::MatrixXcd& drives,
           LoopDriveResult& out) {
  out.full_scale_pa = full_scale > 0.0 ? full_scale : std::numeric_limits<double>::max();
  for (const double p : reached) {
    if (p > 0.0 && full_scale <= 0.0) out.full_scale_pa = std::min(out.full_scale_pa, p);
  }
  for (std::size_t k = 0; k < reached.size(); ++k) {
    if (reached[k] <= 0.0) continue;
    drives.col(static_cast<Index>(k)) *= std::min(1.0, out.full_scale_pa / reached[k]);
    out.short_samples += reached[k] < out.full_scale_pa * (1.0 - 1e-9) ? 1 : 0;
  }
}

void measure_power(const Eigen::MatrixXcd& drives, LoopDriveResult& out) {
  const Eigen::ArrayXXd size = drives.cwiseAbs().array();
  out.largest_drive = size.maxCoeff();
  out.mean_power = size.square().sum() / static_cast<double>(drives.cols());
  out.full_share = static_cast<double>((size > kFull).count()) / static_cast<double>(drives.size());
}

/// Simulates the loop twice, so that the second pass starts from the state at its end.
LoopDrives through_transducers(const Eigen::MatrixXcd& drives, const TransducerSettings& settings) {
  const auto transducers = static_cast<std::size_t>(drives.rows());
  TransducerDynamics dynamics(settings, transducers);
  LoopDrives output(drives.rows(), drives.cols());
  for (Index k = 0; k < 2 * drives.cols(); ++k) {
    const Index sample = k % drives.cols();
    dynamics.step({drives.col(sample).data(), transducers});
    for (std::size_t n = 0; n < transducers; ++n) {
      output(static_cast<Index>(n), sample) = std::complex<float>(dynamics.output()[n]);
    }
  }
  return output;
}

}  // namespace

bool loop_drives(const TransducerArray& array, const Medium& medium, const LoopSamples& loop,
                 const LoopDriveSettings& settings, const std::function<bool(int, int)>& progress,
                 LoopDriveResult& out) {
  require_between("full_scale_pa", settings.full_scale_pa, 0.0, 1e6, "Pa");
  out = LoopDriveResult();
  Eigen::MatrixXcd drives =
      Eigen::MatrixXcd::Zero(static_cast<Index>(array.position.size()), loop.samples);
  std::vector<double> reached(static_cast<std::size_t>(loop.samples), 0.0);
  if (!solve_all(array, medium, loop, settings.focus, progress, drives, reached, out)) return false;
  if (drives.isZero(0.0)) {
    throw std::invalid_argument("the loop is silent throughout: its plan has no pressure on it");
  }
  scale(reached, settings.full_scale_pa, drives, out);
  measure_power(drives, out);
  TransducerSettings transducer = settings.transducer;
  transducer.frequency = array.frequency;
  transducer.sample_rate = loop.sample_rate;
  out.output = through_transducers(drives, transducer);
  return true;
}

}  // namespace prostm
