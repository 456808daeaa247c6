#include "prostm/score/detail/sample_solver.hpp"

#include <complex>

#include "prostm/acoustics/field/propagation.hpp"

namespace prostm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kAboveAll = 1e9;  // target beyond any array, so that drives go up to 1 [Pa]

}  // namespace

Sounding::Sounding(std::span<const FocusSample> foci) {
  for (std::size_t index = 0; index < foci.size(); ++index) {
    const Vec3 p = foci[index].p_D.cast<double>();
    const double wanted = static_cast<double>(foci[index].intensity);
    if (wanted <= 0.0) continue;
    std::size_t place = p_D.size();
    for (std::size_t i = 0; i < p_D.size() && place == p_D.size(); ++i) {
      if ((p - p_D[i]).norm() < kNearestFoci) place = i;
    }
    if (place == p_D.size()) {
      p_D.push_back(p);
      intensity.push_back(wanted);
      focus.push_back(index);
      continue;
    }
    ++merged;
    if (wanted <= intensity[place]) continue;
    p_D[place] = p;
    intensity[place] = wanted;
    focus[place] = index;
  }
}

SampleSolver::SampleSolver(const TransducerArray& array, const Medium& medium,
                           const FocusSettings& settings, int foci)
    : array_(array), medium_(medium), settings_(settings), phase_(VectorXd::Zero(foci)) {}

FocusSolution SampleSolver::solve(const Sounding& s) {
  const Index count = static_cast<Index>(s.p_D.size());
  VectorXd target(count), start(count);
  for (Index m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    target[m] = kAboveAll * s.intensity[i];
    start[m] = phase_[static_cast<Index>(s.focus[i])];
  }
  FocusSolution solution =
      solve_foci(propagation_to(array_, medium_, s.p_D), target, settings_, start);
  for (Index m = 0; m < count; ++m) {
    phase_[static_cast<Index>(s.focus[static_cast<std::size_t>(m)])] =
        std::arg(solution.pressure[m]);
  }
  errors_ = focus_errors(solution, target);
  return solution;
}

double SampleSolver::reached(const FocusSolution& solution) {
  return solution.level * kAboveAll;
}

}  // namespace prostm
