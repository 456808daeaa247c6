#include <vector>

#include "bindings.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/target/field_shape.hpp"

namespace prostm::python {
namespace {

py::array maxima_of(const FieldShape& shape) {
  py::array_t<double> out({static_cast<py::ssize_t>(shape.maxima.size()), py::ssize_t{3}});
  auto rows = out.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const FieldShape::Maximum& maximum = shape.maxima[static_cast<std::size_t>(i)];
    rows(i, 0) = maximum.position.x();
    rows(i, 1) = maximum.position.y();
    rows(i, 2) = maximum.pressure;
  }
  return out;
}

FieldShape shape_of(const TargetField& field) {
  const py::gil_scoped_release unlocked;
  return FieldShapeMeter(field.size()).measure(field);
}

}  // namespace

void bind_shape(py::module_& m) {
  py::class_<FieldShape> shape(m, "FieldShape",
                               "The shape of a field: the maxima that a hand can find in it.");
  shape
      .def_property_readonly(
          "maxima", &maxima_of,
          "(n, 3) x, y in the plane [m] and pressure of each maximum, the largest first, at most "
          "16:\ncells of at least 0.35 of the largest pressure above which no cell within 18 mm\n"
          "along both axes has more.")
      .def_readonly("largest", &FieldShape::largest, "Largest pressure, in the field's unit.")
      .def_readonly("balance", &FieldShape::balance,
                    "The least of the maxima over the largest; 0 without any.")
      .def_readonly("saddle", &FieldShape::saddle,
                    "Highest level at which two of the maxima join, over the largest pressure; 0\n"
                    "with fewer than two.")
      .def_readonly("least_spacing", &FieldShape::least_spacing,
                    "Least distance of two maxima [m]; 0 with fewer than two.")
      .def_readonly(
          "most_spacing", &FieldShape::most_spacing,
          "Largest distance of a maximum to its nearest other [m]; 0 with fewer than two.")
      .def_readonly("area", &FieldShape::area,
                    "Area of at least half of the largest pressure [m²].")
      .def_readonly("force", &FieldShape::force, "Sum of pressure times area of a cell [N].");
  m.def(
      "field_shape", &shape_of,
      "The FieldShape of a TargetField: its maxima, how alike they are, and how deep the saddles\n"
      "between them.",
      py::arg("field"));

  py::class_<GateResult>(m, "GateResult",
                         "Result of a study's gate for a frame: whether the hand is held well and\n"
                         "gets the pressure intended by its scene (docs/design/scenes.md).")
      .def_readonly("passed", &GateResult::pass,
                    "Whether the hand is held well, and 0.8 of the last second's frames are good.")
      .def_readonly("share", &GateResult::share,
                    "Share of the last second's frames that have no problem.")
      .def_property_readonly(
          "problem",
          [](const GateResult& self) { return std::string(name_of(self.finding.problem)); },
          "Name of this frame's first problem; \"none\" without one.")
      .def_property_readonly(
          "sentence", [](const GateResult& self) { return sentence(self); },
          "A sentence with an instruction, or the result.")
      .def_readonly("shape", &GateResult::shape, "FieldShape of the first hand's target.")
      .def("__repr__", [](const GateResult& self) {
        return "GateResult(" + std::string(self.pass ? "passed" : "not passed") + ": " +
               sentence(self) + ")";
      });
}

}  // namespace prostm::python
