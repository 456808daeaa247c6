#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <stdexcept>

#include "bindings.hpp"
#include "plan_result.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/plan/planner.hpp"
#include "settings.hpp"

namespace prostm::python {
namespace {

constexpr std::size_t kDefaultCells = 128 * 128;

/// A planner, and a lock so that several Python threads can share it, one at a time.
template <class P>
struct SharedPlanner {
  template <class S>
  SharedPlanner(const S& settings, std::size_t cells)
      : planner(settings, cells), max_cells(cells) {}
  P planner;
  std::size_t max_cells;
  std::mutex mutex;
};

template <class P, class S>
std::unique_ptr<SharedPlanner<P>> make_planner(const S* settings, const char* type,
                                               long long max_cells, const py::kwargs& values) {
  if (max_cells < 1 || max_cells > static_cast<long long>(kMaxFieldCells)) {
    throw std::invalid_argument("max_cells = " + std::to_string(max_cells) +
                                " must be between 1 and " + std::to_string(kMaxFieldCells));
  }
  S own = settings != nullptr ? *settings : S{};
  set_settings(group_of(type, own), values);
  return std::make_unique<SharedPlanner<P>>(own, static_cast<std::size_t>(max_cells));
}

template <class P>
void check_cells(const TargetField& target, const SharedPlanner<P>& planner) {
  if (target.size() <= planner.max_cells) return;
  throw std::invalid_argument(
      "a raster of " + std::to_string(target.rows) + " x " + std::to_string(target.cols) +
      " cells must have at most the planner's max_cells = " + std::to_string(planner.max_cells));
}

/// Explains InvalidTarget for a field that passed validate().
void check_status(PlanStatus status) {
  if (status != PlanStatus::InvalidTarget) return;
  throw std::invalid_argument(
      "the field cannot be planned: pressures must be at most 1e300 and cells 1e-6 to 1 m wide");
}

/// Plans a TargetField or a TargetFrame. @param call plans one of the two, without the
/// interpreter's lock.
template <class P, class Call>
std::unique_ptr<PlanResult> plan_with(SharedPlanner<P>& self, const py::object& target,
                                      const Call& call) {
  for (const TargetField* patch : patches_of(target)) check_cells(*patch, self);
  const auto* field =
      py::isinstance<TargetField>(target) ? target.cast<const TargetField*>() : nullptr;
  const auto* frame = field == nullptr ? target.cast<const TargetFrame*>() : nullptr;
  auto result = std::make_unique<PlanResult>(target, self.planner.settings());
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.mutex);
    result->status = call(field, frame, *result);
  }
  check_status(result->status);
  return result;
}

std::unique_ptr<PlanResult> plan_paths(SharedPlanner<Planner>& self, const py::object& given,
                                       bool trace, std::optional<double> cell_mm,
                                       std::optional<int> frame_index,
                                       std::optional<double> width_mm, bool invert) {
  const py::object target = target_of(given, file_options(cell_mm, width_mm, frame_index, invert));
  if (trace && py::isinstance<TargetFrame>(target))
    throw std::invalid_argument("a trace is kept of a TargetField only");
  return plan_with(self, target,
                   [&](const TargetField* field, const TargetFrame* frame, PlanResult& r) {
                     if (frame != nullptr) return self.planner.plan(*frame, r.plan, r.stats);
                     if (trace) r.trace.emplace();
                     return self.planner.plan(*field, r.plan, r.stats, trace ? &*r.trace : nullptr);
                   });
}

std::unique_ptr<PlanResult> plan_foci(SharedPlanner<AmPlanner>& self, const py::object& target,
                                      std::optional<double> cell_mm, std::optional<int> frame_index,
                                      std::optional<double> width_mm, bool invert) {
  return plan_with(self, target_of(target, file_options(cell_mm, width_mm, frame_index, invert)),
                   [&](const TargetField* field, const TargetFrame* frame, PlanResult& r) {
                     return frame != nullptr ? self.planner.plan(*frame, r.plan, r.stats)
                                             : self.planner.plan(*field, r.plan, r.stats);
                   });
}

void bind_planner(py::module_& m) {
  py::class_<SharedPlanner<Planner>>(
      m, "Planner",
      "PRO-STM: from a target pressure field to a few closed focal-point paths.\n\n"
      "Keeps its buffers between calls, so make one and use it for many fields. Deterministic: "
      "the\n"
      "same settings and target give the same plan to the bit. The interpreter's lock is released\n"
      "while it plans; threads that share a planner wait for each other.")
      .def(
          py::init([](const PlanSettings* settings, long long max_cells, const py::kwargs& values) {
            return make_planner<Planner>(settings, "PlanSettings", max_cells, values);
          }),
          "settings: PlanSettings, copied; None: the defaults.\n"
          "max_cells: the largest raster, rows * cols, that plan() will be given.\n"
          "Further keywords are settings, e.g. Planner(preset=\"paper\", paths=2).\n\n"
          "Raises ValueError that names the setting, its value and its bound.",
          py::arg("settings") = py::none(), py::arg("max_cells") = kDefaultCells)
      .def_property_readonly(
          "settings",
          [](const SharedPlanner<Planner>& self) { return PlanSettings(self.planner.settings()); },
          "A copy of the settings.")
      .def_readonly("max_cells", &SharedPlanner<Planner>::max_cells, "The largest raster.")
      .def(
          "reset",
          [](SharedPlanner<Planner>& self) {
            const py::gil_scoped_release unlocked;
            const std::lock_guard lock(self.mutex);
            self.planner.reset();
          },
          "Forgets the previous plan, from which the presets best, fast and felt continue.")
      .def("plan", &plan_paths,
           "Plans a TargetField, a TargetFrame (the paths are distributed over its patches, and\n"
           "no path spans two), or the file of a field, given by its name, with cell_mm,\n"
           "width_mm, frame and invert as of read_field(). trace=True keeps the intermediate\n"
           "results of a field.\n\n"
           "Returns a PlanResult. A field without pressure gives a plan without paths. Raises\n"
           "ValueError for more than max_cells cells, a pressure above 1e300, a cell that is not\n"
           "1e-6 to 1 m wide.",
           py::arg("target"), py::arg("trace") = false, py::kw_only(),
           py::arg("cell_mm") = py::none(), py::arg("frame") = py::none(),
           py::arg("width_mm") = py::none(), py::arg("invert") = false);
}

void bind_am_planner(py::module_& m) {
  py::class_<SharedPlanner<AmPlanner>>(
      m, "AmPlanner",
      "Amplitude modulation, the baseline: from a target pressure field to a few focal points\n"
      "that stand still. Each plan is made from scratch. Threads may share a planner.")
      .def(py::init([](const AmSettings* settings, long long max_cells, const py::kwargs& values) {
             return make_planner<AmPlanner>(settings, "AmSettings", max_cells, values);
           }),
           "settings: AmSettings, copied; None: the defaults.\n"
           "max_cells: the largest raster, rows * cols, that plan() will be given.\n"
           "Further keywords are settings, e.g. AmPlanner(foci=2).\n\n"
           "Raises ValueError that names the setting, its value and its bound.",
           py::arg("settings") = py::none(), py::arg("max_cells") = kDefaultCells)
      .def_property_readonly(
          "settings",
          [](const SharedPlanner<AmPlanner>& self) { return AmSettings(self.planner.settings()); },
          "A copy of the settings.")
      .def_readonly("max_cells", &SharedPlanner<AmPlanner>::max_cells, "The largest raster.")
      .def("plan", &plan_foci,
           "Plans a TargetField, a TargetFrame (the foci are distributed over its patches), or\n"
           "the file of a field, given by its name as for Planner.plan().\n\n"
           "Returns a PlanResult. A field without pressure gives a plan without foci. Raises\n"
           "ValueError as Planner.plan() does.",
           py::arg("target"), py::kw_only(), py::arg("cell_mm") = py::none(),
           py::arg("frame") = py::none(), py::arg("width_mm") = py::none(),
           py::arg("invert") = false);
}

// ---- results

py::array points_array(const std::vector<Vec2>& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    array.mutable_data()[2 * i] = points[i].x();
    array.mutable_data()[2 * i + 1] = points[i].y();
  }
  return array;
}

template <class T>
py::array array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

void bind_stats(py::module_& m) {
  py::enum_<PlanStatus>(m, "PlanStatus", "How a call of the planner ended.")
      .value("Planned", PlanStatus::Planned, "the plan holds 1..paths paths")
      .value("EmptyTarget", PlanStatus::EmptyTarget,
             "no skin, or no pressure on it that counts: the plan holds no path")
      .value("InvalidTarget", PlanStatus::InvalidTarget,
             "raised as ValueError in Python, never returned");

  Record<PlanStats>(m, "PlanStats", "Counts of a call, and the time of each stage [s].")
      .quantities()
      .done();

  py::class_<PlanTrace>(m, "PlanTrace", "The intermediate results of the paper's Fig. 2.")
      .def_property_readonly(
          "clusters", [](const PlanTrace& t) { return points_array(t.clusters); },
          "(k, 2) centroids [m].")
      .def_property_readonly(
          "cluster_mass", [](const PlanTrace& t) { return array_of(t.cluster_mass); },
          "(k,) sum of p* of each, p* over its maximum.")
      .def_property_readonly(
          "tour", [](const PlanTrace& t) { return array_of(t.tour); },
          "(k,) the closed tour, indices of clusters.")
      .def_property_readonly(
          "split",
          [](const PlanTrace& t) {
            py::list tours;
            for (const std::vector<int>& tour : t.split) tours.append(array_of(tour));
            return tours;
          },
          "The kept tours, each an array of indices of clusters.");
}

}  // namespace

void bind_plan(py::module_& m) {
  bind_settings<PlanSettings>(
      m, "PlanSettings",
      "Settings of the planner, in SI units; the defaults are the paper's where it gives one.\n"
      "help(PlanSettings) lists them with bounds and meaning.");
  bind_settings<AmSettings>(m, "AmSettings", "Settings of amplitude modulation, in SI units.");
  bind_stats(m);
}

void bind_planners(py::module_& m) {
  bind_planner(m);
  bind_am_planner(m);
}

}  // namespace prostm::python
