#include "prostm/score/running_drives.hpp"

#include <algorithm>
#include <complex>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

using Eigen::Index;

TransducerSettings at_rate(TransducerSettings settings, const TransducerArray& array,
                           double sample_rate) {
  settings.frequency = array.frequency;
  settings.sample_rate = sample_rate;
  return settings;
}

}  // namespace

RunningDrives::RunningDrives(const TransducerArray& array, const Medium& medium,
                             const LoopDriveSettings& settings, int foci, double sample_rate)
    : array_(array),
      full_scale_(settings.full_scale_pa),
      foci_(static_cast<std::size_t>(std::max(foci, 0))),
      solver_(array, medium, settings.focus, foci),
      dynamics_(at_rate(settings.transducer, array, sample_rate), array.position.size()) {
  require_between("full_scale_pa", full_scale_, 1e-3, 1e6, "Pa");
  require_between("foci", foci, 1, 8);
}

void RunningDrives::next(std::span<const FocusSample> samples, LoopDrives& out) {
  const std::size_t count = samples.size() / foci_, transducers = array_.position.size();
  out.resize(static_cast<Index>(transducers), static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const Sounding s(samples.subspan(k * foci_, foci_));
    Eigen::VectorXcd drive = Eigen::VectorXcd::Zero(static_cast<Index>(transducers));
    if (!s.p_D.empty()) {
      const FocusSolution solution = solver_.solve(s);
      const double reached = SampleSolver::reached(solution);
      drive = solution.drive * std::min(1.0, full_scale_ / reached);
      short_samples_ += reached < full_scale_ * (1.0 - 1e-9) ? 1 : 0;
    }
    dynamics_.step({drive.data(), transducers});
    for (std::size_t n = 0; n < transducers; ++n) {
      out(static_cast<Index>(n), static_cast<Index>(k)) =
          std::complex<float>(dynamics_.output()[n]);
    }
  }
}

}  // namespace prostm
