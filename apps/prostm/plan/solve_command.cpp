#include <fmt/format.h>

#include <cmath>

#include "common.hpp"
#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/io/foci_file.hpp"

namespace prostm::app {

int solve_command(const SolveOptionsGiven& options) {
  const TransducerArray array = array_from_name(options.array);
  FocusSettings settings;
  settings.method = solver_of(options.solver);
  const FociFile foci = read_foci(options.foci);

  const Medium air;
  const Propagation propagation = propagation_to(array, air, foci.position);
  const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(
      foci.pressure.data(), static_cast<Eigen::Index>(foci.pressure.size()));
  const FocusSolution solution = solve_foci(propagation, target, settings);
  const Eigen::VectorXd errors = focus_errors(solution, target);

  std::FILE* out = prose(options.json);
  fmt::print(out, "{} on {}: {} focal points at {:.1f} % of the requested pressure\n",
             options.solver, array.name, target.size(), 100.0 * solution.level);
  fmt::print(out, "  {:>6} {:>10} {:>10} {:>22}\n", "focus", "asked Pa", "reached Pa",
             "error of its share, %");
  for (Eigen::Index m = 0; m < target.size(); ++m) {
    // a point without a requested pressure has no share
    const std::string error = target[m] > 0.0 ? fmt::format("{:.2f}", 100.0 * errors[m]) : "-";
    fmt::print(out, "  {:>6} {:>10.1f} {:>10.1f} {:>22}\n", m + 1, target[m],
               std::abs(solution.pressure[m]), error);
  }
  const double high = array.amplitude_high / array.amplitude;
  if (high > 1.0) {
    fmt::print(out, "sources differ on the array: between {:.2f} and {:.2f} times as much\n",
               array.amplitude_low / array.amplitude, high);
  }
  if (!options.json.empty()) write_file(options.json, drives_to_json(array, air, foci, solution));
  say_written(out, options.json);
  return 0;
}

}  // namespace prostm::app
