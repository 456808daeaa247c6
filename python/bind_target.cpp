#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bindings.hpp"
#include "prostm/target/rounding.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::python {
namespace {

const char* const kTargetFieldDoc =
    R"(The target: the pressure that is to be felt on the skin, on a regular raster of a plane.

Row-major: the centre of cell (row, col) lies at origin + cell * (col, row) in the plane, row 0 has
the smallest y. A field does not change once it is made: its arrays are read-only views, and one
field may be planned by several threads at once.)";

const char* const kTargetFieldInitDoc =
    R"(pressure: (rows, cols) numbers, NaN = no skin, else finite and >= 0 in any unit; a solver's
    rounding, negative down to 1e-6 of the largest, becomes 0.
cell or cell_mm: edge of a cell [m] or [mm]; exactly one of them.
origin: (2,) centre of cell (0, 0) in the plane [m].
height: None (flat) or (rows, cols), the skin's distance from the plane along its normal [m],
    positive away from the array; values off the skin do not count.
X_DP: None (parallel to the array, 200 mm above its centre) or the plane's pose in the device's
    frame, a homogeneous (4, 4) matrix in metres.
weight: None (1 everywhere) or (rows, cols), how much the error of each cell counts where the presets
    best, fast and felt fit a plan: finite and >= 0, above 0 somewhere on the skin; only ratios matter,
    and values off the skin do not count.

A masked array's masked cells are no skin. Raises ValueError, TypeError.)";

/// Returns the user's pressure as numbers; masked cells of a numpy.ma array are NaN.
Numbers pressures(py::handle given) {
  if (!py::hasattr(given, "filled")) return numbers(given, "pressure", 2, kMaxFieldCells);
  return numbers(given.attr("astype")("float64").attr("filled")(std::nan("")), "pressure", 2,
                 kMaxFieldCells);
}

/// Returns the pressures as users give them: NaN where there is no skin. Read-only.
py::array_t<double> pressures_of(const TargetField& field) {
  py::array_t<double> pressure({field.rows, field.cols}, field.pressure.data());
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] == 0) pressure.mutable_data()[i] = std::nan("");
  }
  py::detail::array_proxy(pressure.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return pressure;
}

void set_shape(TargetField& field, const Numbers& pressure) {
  const auto rows = pressure.shape(0), cols = pressure.shape(1);
  if (rows < 1 || cols < 1) {
    throw std::invalid_argument("a raster of " + std::to_string(rows) + " x " +
                                std::to_string(cols) +
                                " cells must have at least one row and one column");
  }
  field.resize(static_cast<int>(rows), static_cast<int>(cols));
}

void set_heights(TargetField& field, const py::object& height) {
  if (height.is_none()) return;
  const Numbers given = numbers(height, "height", {field.rows, field.cols});
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) field.height[i] = given.data()[i];
  }
  validate(field);
  fill_heights(field);
}

void set_weights(TargetField& field, const py::object& weight) {
  if (weight.is_none()) return;
  const Numbers given = numbers(weight, "weight", {field.rows, field.cols});
  field.weight.assign(field.size(), 0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) field.weight[i] = given.data()[i];
  }
  validate(field);
}

TargetField make_field(const py::object& pressure, std::optional<double> cell,
                       std::optional<double> cell_mm, const py::object& origin,
                       const py::object& height, const py::object& X_DP, const py::object& weight) {
  const Numbers p = pressures(pressure);
  if (cell.has_value() == cell_mm.has_value()) {
    throw std::invalid_argument(
        "the edge of a cell must be given once: as cell in metres or as cell_mm in millimetres");
  }
  TargetField field;
  set_shape(field, p);
  // the same division as for the millimetres of a file, so that both agree to the bit
  field.cell = cell ? *cell : *cell_mm / 1000.0;
  const Numbers corner = numbers(origin, "origin", std::vector<py::ssize_t>{2});
  field.origin = Vec2(corner.data()[0], corner.data()[1]);
  if (!X_DP.is_none()) field.X_DP = pose_from(X_DP, "X_DP");
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (std::isnan(p.data()[i])) continue;
    field.skin[i] = 1;
    field.pressure[i] = p.data()[i];
  }
  clear_rounding(field);
  validate(field);
  set_heights(field, height);
  set_weights(field, weight);
  return field;
}

std::vector<py::ssize_t> shape_of(const TargetField& field) {
  return {field.rows, field.cols};
}

/// A view of values that a field may lack; None without them.
py::object optional_view(const py::object& self, std::vector<double> TargetField::*values) {
  const auto& field = self.cast<const TargetField&>();
  if ((field.*values).empty()) return py::none();
  return view(shape_of(field), (field.*values).data(), self);
}

py::array heights_at(const TargetField& field, const py::object& x) {
  const Numbers points = numbers(x, "x", 2);
  if (points.shape(1) != 2) {
    throw std::invalid_argument("x must have the shape (n, 2), a point in each row");
  }
  py::array_t<double> heights(points.shape(0));
  const auto p = points.unchecked<2>();
  auto out = heights.mutable_unchecked<1>();
  for (py::ssize_t i = 0; i < points.shape(0); ++i) {
    if (!std::isfinite(p(i, 0)) || !std::isfinite(p(i, 1))) {
      throw std::invalid_argument("x must be finite, and is not in row " + std::to_string(i));
    }
    out(i) = height_at(field, Vec2(p(i, 0), p(i, 1)));
  }
  return heights;
}

TargetFrame make_frame(const std::vector<const TargetField*>& patches, double time) {
  if (patches.size() > static_cast<std::size_t>(kMaxPatches)) {
    throw std::invalid_argument("a frame has " + std::to_string(patches.size()) +
                                " patches; it must have at most " + std::to_string(kMaxPatches));
  }
  if (!std::isfinite(time)) throw std::invalid_argument("the time of a frame must be finite");
  TargetFrame frame;
  frame.time = time;
  for (const TargetField* patch : patches) {
    if (patch == nullptr) throw py::type_error("a patch must be a TargetField, not None");
    frame.patches.push_back(*patch);
  }
  return frame;
}

void bind_field(py::module_& m) {
  py::class_<TargetField>(m, "TargetField", kTargetFieldDoc)
      .def(py::init(&make_field), kTargetFieldInitDoc, py::arg("pressure"),
           py::arg("cell") = py::none(), py::kw_only(), py::arg("cell_mm") = py::none(),
           py::arg("origin") = py::make_tuple(0.0, 0.0), py::arg("height") = py::none(),
           py::arg("X_DP") = py::none(), py::arg("weight") = py::none())
      .def_readonly("rows", &TargetField::rows, "Number of rows.")
      .def_readonly("cols", &TargetField::cols, "Number of columns.")
      .def_property_readonly(
          "shape", [](const TargetField& f) { return py::make_tuple(f.rows, f.cols); },
          "(rows, cols).")
      .def_readonly("cell", &TargetField::cell, "Edge of a cell [m].")
      .def_property_readonly(
          "origin",
          [](const py::object& self) {
            return view({2}, self.cast<const TargetField&>().origin.data(), self);
          },
          "(2,) centre of cell (0, 0) in the plane [m]; a view.")
      .def_property_readonly(
          "pressure", &pressures_of,
          "(rows, cols) target pressure p*, >= 0, NaN where there is no skin; a copy.")
      .def_property_readonly(
          "skin",
          [](const py::object& self) {
            const auto& f = self.cast<const TargetField&>();
            return view(py::dtype::of<bool>(), shape_of(f), f.skin.data(), self);
          },
          "(rows, cols) of bool: where there is skin; a view.")
      .def_property_readonly(
          "height",
          [](const py::object& self) {
            const auto& f = self.cast<const TargetField&>();
            return view(shape_of(f), f.height.data(), self);
          },
          "(rows, cols) height of the skin along the plane's normal [m], continued off the skin; "
          "a view.")
      .def_property_readonly(
          "weight",
          [](const py::object& self) { return optional_view(self, &TargetField::weight); },
          "(rows, cols) how much the error of each cell counts, 0 where there is no skin; a view. "
          "None: 1 everywhere.")
      .def_property_readonly(
          "smoke", [](const py::object& self) { return optional_view(self, &TargetField::smoke); },
          "(rows, cols) part of the air's pressure that is due to the smoke, of either sign, 0 "
          "where "
          "there is no skin; a view. None: unknown, as in a field that was not recorded with "
          "[contact] parts.")
      .def_property_readonly(
          "movement",
          [](const py::object& self) { return optional_view(self, &TargetField::movement); },
          "(rows, cols) part of the air's pressure that is due to the hand's own movement, of "
          "either "
          "sign, 0 where there is no skin; a view. None: unknown.")
      .def_property_readonly(
          "X_DP", [](const TargetField& f) { return pose_matrix(f.X_DP); },
          "(4, 4) pose of the plane in the device's frame [m]; a copy.")
      .def("__repr__",
           [](const TargetField& f) {
             return "TargetField(" + std::to_string(f.rows) + " x " + std::to_string(f.cols) +
                    " cells of " + std::string(py::repr(py::float_(f.cell))) + " m)";
           })
      .def(py::pickle(
          [](const TargetField& f) {
            const auto copy = [&](const std::vector<double>& values) {
              return py::array_t<double>(shape_of(f), values.data());
            };
            return py::make_tuple(
                pressures_of(f), f.cell, py::make_tuple(f.origin.x(), f.origin.y()), copy(f.height),
                pose_matrix(f.X_DP), f.weight.empty() ? py::object(py::none()) : copy(f.weight),
                f.smoke, f.movement);
          },
          [](const py::tuple& t) {
            TargetField field =
                make_field(t[0], t[1].cast<double>(), std::nullopt, t[2], t[3], t[4], t[5]);
            field.smoke = t[6].cast<std::vector<double>>();
            field.movement = t[7].cast<std::vector<double>>();
            validate(field);
            return field;
          }));
}

}  // namespace

std::vector<const TargetField*> patches_of(py::handle target) {
  if (py::isinstance<TargetField>(target)) return {target.cast<const TargetField*>()};
  if (!py::isinstance<TargetFrame>(target)) {
    throw py::type_error(
        "target must be a TargetField, a TargetFrame or, to be planned, the name of a file, not " +
        described(target));
  }
  std::vector<const TargetField*> patches;
  for (const TargetField& patch : target.cast<const TargetFrame&>().patches)
    patches.push_back(&patch);
  return patches;
}

double largest_pressure(py::handle target) {
  double largest = 0.0;
  for (const TargetField* patch : patches_of(target))
    largest = std::max(largest, max_pressure(*patch));
  return largest;
}

void bind_target(py::module_& m) {
  m.attr("kMaxFieldCells") = kMaxFieldCells;
  m.attr("kMaxPatches") = kMaxPatches;
  bind_field(m);
  py::class_<TargetFrame>(m, "TargetFrame",
                          "One frame of targets: a patch per hand, each with its own plane.")
      .def(py::init(&make_frame),
           "patches: at most 2 TargetFields, which are copied. time: time of the hand frame [s].",
           py::arg("patches"), py::arg("time") = 0.0)
      .def_readonly("time", &TargetFrame::time, "Time of the hand frame [s].")
      .def_property_readonly(
          "patches",
          [](const py::object& self) {
            py::list patches;
            for (const TargetField& patch : self.cast<const TargetFrame&>().patches) {
              patches.append(py::cast(&patch, py::return_value_policy::reference_internal, self));
            }
            return patches;
          },
          "The TargetFields, as a new list.");

  m.def("max_pressure", &largest_pressure,
        "Largest pressure of a TargetField or a TargetFrame; 0 without skin.", py::arg("target"));
  m.def("height_at", &heights_at,
        "Height of the skin at points of the plane: x (n, 2) [m] gives (n,) [m], bilinear between "
        "cell centres, clamped to the raster's border.",
        py::arg("field"), py::arg("x"));
}

}  // namespace prostm::python
