#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <stdexcept>

#include "bindings.hpp"
#include "core/file.hpp"
#include "core/require.hpp"
#include "io/plan_file.hpp"
#include "io/settings_file.hpp"
#include "plan_result.hpp"
#include "score/score.hpp"

namespace prostm::python {
namespace {

Metrics metrics_of(const PlanResult& result, int patch) {
  const TargetField& field = result.patch(patch);
  const py::gil_scoped_release unlocked;
  return score_plan(field, result.plan, patch, result.sigma(), result.gain_law());
}

void write(const PlanResult& result, const std::filesystem::path& path) {
  if (!py::isinstance<TargetField>(result.target)) {
    throw std::invalid_argument("a plan file holds the plan of one TargetField, not of a frame");
  }
  const TargetField& field = result.patch(0);
  const py::gil_scoped_release unlocked;
  const Metrics metrics = score_plan(field, result.plan, 0, result.sigma(), result.gain_law());
  const SettingsInFile settings(result.settings);
  PlanFileExtras extras;
  extras.method = settings.method;
  extras.preset = settings.preset;
  extras.stats = &result.stats;
  extras.metrics = &metrics;
  write_file(path.string(), plan_to_json(result.plan, field, extras, settings.json));
}

}  // namespace

SettingsInFile::SettingsInFile(AnySettings settings) {
  if (auto* am = std::get_if<AmSettings>(&settings)) {
    method = Method::Am;
    json = settings_to_json({{"am", [am](SettingsVisitor& v) { am->visit(v); }}});
  } else {
    auto& plan = std::get<PlanSettings>(settings);
    method = Method::ProStm;
    preset = plan.preset;
    json = settings_to_json({{"plan", [&plan](SettingsVisitor& v) { plan.visit(v); }}});
  }
}

double PlanResult::sigma() const {
  return std::visit([](const auto& s) { return s.sigma; }, settings);
}

GainLaw PlanResult::gain_law() const {
  const auto* of_paths = std::get_if<PlanSettings>(&settings);
  return of_paths != nullptr ? of_paths->gain_law() : GainLaw{};  // foci have no γ
}

const TargetField& PlanResult::patch(int index) const {
  if (py::isinstance<TargetField>(target)) {
    require_between("patch", index, 0, 0);
    return target.cast<const TargetField&>();
  }
  const auto& frame = target.cast<const TargetFrame&>();
  require_between("patch", index, 0, static_cast<int>(frame.patches.size()) - 1);
  return frame.patches[static_cast<std::size_t>(index)];
}

void bind_result(py::module_& m) {
  py::class_<PlanResult>(m, "PlanResult", "What one call of the planner gave, and was given.")
      .def_readonly("status", &PlanResult::status, "PlanStatus: Planned or EmptyTarget.")
      .def_readonly("plan", &PlanResult::plan, "The Plan.")
      .def_property_readonly(
          "paths",
          [](const py::object& self) -> py::object { return self.attr("plan").attr("paths"); },
          "The plan's FocalPaths, as a new list.")
      .def_property_readonly(
          "foci",
          [](const py::object& self) -> py::object { return self.attr("plan").attr("foci"); },
          "The plan's FocalPoints, as a new list.")
      .def_readonly("stats", &PlanResult::stats, "PlanStats: counts, and times [s].")
      .def_readonly("trace", &PlanResult::trace,
                    "PlanTrace of the intermediate results, or None when none was asked for.")
      .def_readonly("target", &PlanResult::target, "The TargetField or TargetFrame.")
      .def_property_readonly(
          "settings", [](const PlanResult& r) { return AnySettings(r.settings); },
          "A copy of the PlanSettings or AmSettings.")
      .def("metrics", &metrics_of, "score_plan() with the planner's sigma and gain.",
           py::arg("patch") = 0)
      .def(
          "quasi_static_field",
          [](const PlanResult& r, int patch) {
            return quasi_static_array(r.plan, r.patch(patch), r.sigma(), r.gain_law(), patch);
          },
          "Eq. (1) on the target's raster with the planner's sigma and gain: (rows, cols).",
          py::arg("patch") = 0)
      .def("write", &write,
           "Writes a plan file (prostm-plan/1) with stage times, metrics and the planner's "
           "settings.",
           py::arg("path"))
      .def("__repr__", [](const py::object& self) {
        return "PlanResult(" + std::string(py::str(self.attr("status"))) + ", " +
               std::string(py::repr(self.attr("plan"))) + ")";
      });
}

}  // namespace prostm::python
