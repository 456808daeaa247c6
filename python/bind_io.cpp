#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "bindings.hpp"
#include "hdf5_turn.hpp"
#include "plan_result.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/io/plan_file.hpp"

namespace prostm::python {
namespace {

using Path = std::filesystem::path;
constexpr std::size_t kMaxPlanBytes = std::size_t{64} << 20;

/// Whether HDF5 reads the file.
bool is_recording(const Path& path) {
  return path.extension() == ".h5" || path.extension() == ".H5";
}

TargetField read_field_file(const Path& path, const FieldFileOptions& options) {
  if (is_recording(path)) {
    const Hdf5Turn turn;
    return read_field(path.string(), options);
  }
  const py::gil_scoped_release unlocked;
  return read_field(path.string(), options);
}

std::string plan_text(const Plan& plan, const TargetField& target, const AnySettings& settings,
                      const PlanStats* stats, const Metrics* metrics,
                      const std::optional<std::vector<Control>>& controls) {
  const SettingsInFile in_file(settings);
  if (in_file.method == Method::Am ? !plan.paths.empty() : !plan.foci.empty()) {
    throw std::invalid_argument(
        "a plan of paths goes with PlanSettings, a plan of foci with AmSettings");
  }
  PlanFileExtras extras;
  extras.method = in_file.method;
  extras.preset = in_file.preset;
  extras.stats = stats;
  extras.metrics = metrics;
  extras.controls = controls ? &*controls : nullptr;
  return plan_to_json(plan, target, extras, in_file.groups);
}

void write_plan_file(const Path& path, const Plan& plan, const TargetField& target,
                     const AnySettings& settings, const PlanStats* stats, const Metrics* metrics,
                     const std::optional<std::vector<Control>>& controls) {
  const py::gil_scoped_release unlocked;
  write_file(path.string(), plan_text(plan, target, settings, stats, metrics, controls));
}

void bind_fields(py::module_& m) {
  m.def(
      "read_field",
      [](const Path& path, std::optional<double> cell_mm, std::optional<int> frame, bool invert,
         std::optional<double> width_mm, const std::string& variable) {
        FieldFileOptions options = file_options(cell_mm, width_mm, frame, invert);
        options.variable = variable;
        return read_field_file(path, options);
      },
      "Reads a field by the ending of its name, as the command line does: .json\n"
      "(prostm-field/1), .npy, .npz and .png (which need cell_mm, or the width of the whole field\n"
      "as width_mm), .h5. frame: of a .h5 (default 0) or of a 3-D array. invert: a .png is drawn "
      "black on\n"
      "white, so that black is the pressure. variable: the array of an .npz that holds several.\n"
      "Raises InputError, a ValueError, with a sentence that names the file.",
      py::arg("path"), py::arg("cell_mm") = py::none(), py::arg("frame") = py::none(),
      py::kw_only(), py::arg("invert") = false, py::arg("width_mm") = py::none(),
      py::arg("variable") = "");
  m.def(
      "write_field",
      [](const Path& path, const TargetField& field) {
        const py::gil_scoped_release unlocked;
        write_file(path.string(), field_to_json(field));
      },
      "Writes prostm-field/1 (JSON).", py::arg("path"), py::arg("field"));
  m.def("field_to_json", &field_to_json, "The field as prostm-field/1, a string.",
        py::arg("field"));
  m.def("field_from_json", &field_from_json,
        "Parses prostm-field/1; `name` stands for the file in messages.", py::arg("text"),
        py::arg("name") = "the text");
}

void bind_plans(py::module_& m) {
  py::class_<PlanFile>(m, "PlanFile", "The contents of a plan file.")
      .def_readonly("plan", &PlanFile::plan, "The Plan.")
      .def_readonly("raster", &PlanFile::raster,
                    "TargetField with plane, skin and heights; its pressure is 0 on the skin.");
  m.def(
      "read_plan",
      [](const Path& path) {
        const py::gil_scoped_release unlocked;
        return plan_from_json(read_file(path.string(), kMaxPlanBytes), path.string());
      },
      "Reads a plan file (prostm-plan/1) as a PlanFile. Raises InputError, a ValueError.",
      py::arg("path"));
  m.def("plan_from_json", &plan_from_json,
        "Parses prostm-plan/1; `name` stands for the file in messages.", py::arg("text"),
        py::arg("name") = "the text");
  m.def(
      "write_plan", &write_plan_file,
      "Writes a plan file (prostm-plan/1). target: the TargetField that was planned, whose plane\n"
      "and heights are repeated in the file. settings: PlanSettings for paths, AmSettings for\n"
      "foci. Arguments that are None are left out.",
      py::arg("path"), py::arg("plan"), py::arg("target"), py::arg("settings"),
      py::arg("stats") = py::none(), py::arg("metrics") = py::none(),
      py::arg("controls") = py::none());
  m.def("plan_to_json", &plan_text,
        "The plan as prostm-plan/1, a string, as write_plan() writes it.", py::arg("plan"),
        py::arg("target"), py::arg("settings"), py::arg("stats") = py::none(),
        py::arg("metrics") = py::none(), py::arg("controls") = py::none());
}

}  // namespace

FieldFileOptions file_options(std::optional<double> cell_mm, std::optional<double> width_mm,
                              std::optional<int> frame, bool invert) {
  return {cell_mm, width_mm, frame, invert, {"cell_mm", "width_mm", "frame", "invert", "variable"},
          {}};
}

py::object target_of(const py::object& target, const FieldFileOptions& options) {
  if (py::isinstance<py::str>(target) || py::hasattr(target, "__fspath__"))
    return py::cast(read_field_file(target.cast<Path>(), options));
  if (!options.cell_mm && !options.width_mm && !options.frame && !options.invert) return target;
  const bool sized = py::isinstance<TargetField>(target) || py::isinstance<TargetFrame>(target);
  throw std::invalid_argument(
      "cell_mm, width_mm, frame and invert belong to the name of a file, not to " +
      described(target) + (sized ? "" : "; make it a TargetField, which takes cell_mm"));
}

void bind_io(py::module_& m) {
  bind_fields(m);
  bind_plans(m);
}

}  // namespace prostm::python
