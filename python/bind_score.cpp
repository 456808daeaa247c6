#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "plan_result.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/require.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm::python {
namespace {

Metrics score_array(const TargetField& target, const py::object& rendered, double coverage) {
  const Numbers given = numbers(rendered, "rendered", {target.rows, target.cols});
  const std::vector<double> cells(given.data(), given.data() + given.size());
  if (!std::all_of(cells.begin(), cells.end(), [](double x) { return std::isfinite(x); })) {
    throw std::invalid_argument("rendered must be finite in every cell");
  }
  require_between("coverage", coverage, 0.0, 1.0);
  const py::gil_scoped_release unlocked;
  return score_field(target, cells, coverage);
}

Metrics score(const TargetField& target, const Plan& plan, double sigma, double gain, int patch,
              double gain_exponent, double draw_rate, bool gain_from_skin) {
  const GainLaw law{gain, gain_exponent, draw_rate, gain_from_skin};
  check_model(sigma, law, patch);
  const py::gil_scoped_release unlocked;
  return score_plan(target, plan, patch, sigma, law);
}

std::vector<Control> controls_of(const TargetField& target, double sigma, double gain,
                                 double length, const Plan* other, std::uint64_t seed,
                                 double gain_exponent, double draw_rate, bool gain_from_skin) {
  const GainLaw law{gain, gain_exponent, draw_rate, gain_from_skin};
  check_model(sigma, law, 0);
  require_between("length", length, 0.01, 1.0, "m");
  const py::gil_scoped_release unlocked;
  return controls(target, sigma, law, length, other, seed);
}

}  // namespace

void bind_score(py::module_& m) {
  const PlanSettings defaults;
  Record<Metrics>(m, "Metrics",
                  "How well a field renders its target, over the skin, both divided by max p*\n"
                  "(docs/design/quality.md).")
      .quantities()
      .done();
  Record<Control>(m, "Control", "The metrics of a field or plan that a good plan must beat.")
      .field("name", &Control::name, "Its name.")
      .field("metrics", &Control::metrics, "Its Metrics.")
      .done();

  m.def("score_plan", &score,
        "Metrics of a plan on a target, through Eq. (1) with sigma [m] and the gain of each path "
        "(see\n"
        "quasi_static_field); all zeros for a target without pressure.",
        py::arg("target"), py::arg("plan"), py::arg("sigma") = defaults.sigma,
        py::arg("gain") = defaults.gain, py::arg("patch") = 0,
        py::arg("gain_exponent") = defaults.gain_exponent,
        py::arg("draw_rate") = defaults.draw_rate,
        py::arg("gain_from_skin") = defaults.gain_from_skin);
  m.def("score_field", &score_array,
        "Metrics of any field: rendered (rows, cols), finite, the effective field in the target's\n"
        "unit. coverage is passed through.",
        py::arg("target"), py::arg("rendered"), py::arg("coverage") = 0.0);
  m.def("controls", &controls_of,
        "The controls that a plan on a target must outperform, as a list of Control; empty\n"
        "for a target without pressure: a flat field; four circles at the mass centres; random\n"
        "circles with solved pressures (the median of 20 draws); and, when `other` is given, the\n"
        "paths of that Plan moved here. sigma and length (of a circle, drawn draw_rate times a\n"
        "second) in metres; the gain of each path as in quasi_static_field.",
        py::arg("target"), py::arg("sigma") = defaults.sigma, py::arg("gain") = defaults.gain,
        py::arg("length") = defaults.max_length(), py::arg("other") = py::none(),
        py::arg("seed") = 1, py::arg("gain_exponent") = defaults.gain_exponent,
        py::arg("draw_rate") = defaults.draw_rate,
        py::arg("gain_from_skin") = defaults.gain_from_skin);
  m.def(
      "sensation_interval",
      [](const std::string& array) {
        const SensationInterval interval = sensation_interval(array_from_name(array));
        return std::pair(interval.below, interval.above);
      },
      "Distances (below, above) from a sensation_level to the ends of its interval of 95 % over\n"
      "people and arrays [dB]. array: a name, as --array takes it, or a file.",
      py::arg("array") = "usx");
  m.def(
      "sensation_words",
      [](double level, const std::string& array) {
        require_between("level", level, -400.0, 400.0, "dB");
        return sensation_words(level, sensation_interval(array_from_name(array)));
      },
      "A sensation_level with its interval, and what it means, as text. Raises ValueError for a\n"
      "level that is not finite.",
      py::arg("level"), py::arg("array") = "usx");
}

}  // namespace prostm::python
