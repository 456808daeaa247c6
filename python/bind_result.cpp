#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <stdexcept>

#include "bindings.hpp"
#include "plan_result.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/require.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/io/plan_file.hpp"
#include "prostm/score/plan_percept.hpp"
#include "prostm/score/score.hpp"

namespace prostm::python {
namespace {

constexpr double kSampleRate = 40e3;  // default [Hz]

Metrics metrics_of(const PlanResult& result, int patch, const EmitSettings* emission,
                   double sample_rate, const std::optional<std::string>& array) {
  const TargetField& field = result.patch(patch);
  const SegmentPressures played = result.played(emission, sample_rate);
  const double sigma = result.sigma(patch);
  const GainLaw gain = result.gain_law();
  Metrics metrics;
  {
    const py::gil_scoped_release unlocked;
    metrics = score_plan(field, result.plan, patch, sigma, gain, &played);
  }
  if (array) {
    const TargetFrame frame = result.frame();
    const EmitSettings emit = result.emission(emission);
    const py::gil_scoped_release unlocked;
    WorkerPool pool(1);
    const PlanPercept percept =
        plan_percept(result.plan, frame, patch, emit, sample_rate, array_from_name(*array), pool);
    metrics.felt_skill = percept.skill;
    metrics.sensation_level = percept.sensation_level;
  }
  return metrics;
}

py::array field_of(const PlanResult& result, int patch, const EmitSettings* emission,
                   double sample_rate) {
  const TargetField& field = result.patch(patch);
  const SegmentPressures played = result.played(emission, sample_rate);
  return quasi_static_array(result.plan, field, result.sigma(patch), result.gain_law(), patch,
                            &played);
}

void write(const PlanResult& result, const std::filesystem::path& path) {
  if (!py::isinstance<TargetField>(result.target)) {
    throw std::invalid_argument("a plan file holds the plan of one TargetField, not of a frame");
  }
  const TargetField& field = result.patch(0);
  const SegmentPressures played = result.played(nullptr, kSampleRate);
  PlanQuality quality;
  quality.sigma = result.sigma(0);
  quality.full_scale_pressure = result.emission(nullptr).full_scale_pressure;
  const py::gil_scoped_release unlocked;
  const GainLaw gain = result.gain_law();
  quality.planned = score_plan(field, result.plan, 0, quality.sigma, gain);
  quality.played = score_plan(field, result.plan, 0, quality.sigma, gain, &played);
  const SettingsInFile settings(result.settings);
  PlanFileExtras extras;
  extras.method = settings.method;
  extras.preset = settings.preset;
  extras.stats = &result.stats;
  extras.quality = &quality;
  extras.program = version_text();
  write_file(path.string(), plan_to_json(result.plan, field, extras, settings.groups));
}

}  // namespace

SettingsInFile::SettingsInFile(const AnySettings& settings) {
  if (const auto* am = std::get_if<AmSettings>(&settings)) {
    method = Method::Am;
    groups = {group_of("am", *am)};
  } else {
    const auto& plan = std::get<PlanSettings>(settings);
    method = Method::ProStm;
    preset = plan.preset;
    groups = {group_of("plan", plan)};
  }
}

double PlanResult::sigma(int patch) const {
  if (recorded) return recorded->sigma[static_cast<std::size_t>(patch)];
  return std::visit([](const auto& s) { return s.sigma; }, settings);
}

GainLaw PlanResult::gain_law() const {
  const auto* of_paths = std::get_if<PlanSettings>(&settings);
  return of_paths != nullptr ? of_paths->gain_law() : GainLaw{};  // AM has no γ
}

const TargetField& PlanResult::patch(int index) const {
  const std::vector<const TargetField*> patches = patches_of(target);
  require_between("patch", index, 0, static_cast<int>(patches.size()) - 1);
  return *patches[static_cast<std::size_t>(index)];
}

EmitSettings PlanResult::emission(const EmitSettings* given) const {
  EmitSettings emit = recorded ? recorded->emission : EmitSettings{};
  if (given != nullptr) emit = *given;
  if (emit.full_scale_pressure != 0.0) return emit;
  emit.full_scale_pressure = own_full_scale(gain_law().gain, largest_pressure(target));
  return emit;
}

TargetFrame PlanResult::frame() const {
  if (!py::isinstance<TargetField>(target)) return target.cast<const TargetFrame&>();
  TargetFrame frame;
  frame.patches.push_back(patch(0));
  return frame;
}

SegmentPressures PlanResult::played(const EmitSettings* given, double sample_rate) const {
  if (plan.empty()) return {};
  const EmitSettings emit = emission(given);
  const TargetFrame frame = this->frame();
  const py::gil_scoped_release unlocked;
  return played_pressures(plan, frame, emit, sample_rate);
}

void bind_result(py::module_& m) {
  py::class_<PlanResult>(m, "PlanResult",
                         "A plan with its target, its settings and how it was made.")
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
                    "PlanTrace of the intermediate results; None unless it was asked for.")
      .def_readonly("target", &PlanResult::target, "The TargetField or TargetFrame.")
      .def_property_readonly(
          "settings", [](const PlanResult& r) { return AnySettings(r.settings); },
          "A copy of the PlanSettings or AmSettings.")
      .def_property_readonly(
          "emission", [](const PlanResult& r) { return r.emission(nullptr); },
          "EmitSettings that play the plan, as a copy: the defaults with a full scale of the gain\n"
          "times the target's largest pressure, or those of the recording that contains the plan.")
      .def("metrics", &metrics_of,
           "Metrics of the field that is played, with the planner's sigma and gain.\n\n"
           "emission: EmitSettings; None: the attribute emission. A full scale of 0 is the gain\n"
           "times the target's largest pressure. array: a name, as --array takes it, or a file, "
           "whose\n"
           "output felt_skill and sensation_level judge; without it they are NaN. score_plan()\n"
           "gives the metrics of the planned pressures.",
           py::arg("patch") = 0, py::arg("emission") = py::none(),
           py::arg("sample_rate") = kSampleRate, py::arg("array") = py::none())
      .def(
          "quasi_static_field", &field_of,
          "The reconstruction: Eq. (1) with the played pressures on the target's raster, (rows,\n"
          "cols), with the planner's sigma and gain. emission, sample_rate: as for metrics(). The\n"
          "function of this name takes the planned pressures.",
          py::arg("patch") = 0, py::arg("emission") = py::none(),
          py::arg("sample_rate") = kSampleRate)
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
