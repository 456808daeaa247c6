/// Shared parts of the experiments.
#include "prostm/experiments/experiments.hpp"

#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/experiments/stimuli.hpp"

namespace prostm::experiments {

double peak_place(const std::vector<double>& x, const std::vector<double>& y) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    if (y[i] > y[best]) best = i;
  }
  if (best == 0 || best + 1 == y.size()) return x[best];
  const double before = y[best - 1], at = y[best], after = y[best + 1];
  return x[best] + 0.5 * (x[best] - x[best - 1]) * (before - after) / (before - 2.0 * at + after);
}

}  // namespace prostm::experiments
