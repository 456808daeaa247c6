#include <pybind11/stl.h>

#include <stdexcept>

#include "bindings.hpp"
#include "plan_result.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/text/number_text.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::python {
namespace {

constexpr double kLargestPressure = 1e300, kLargestCoordinate = 1e3;  // [unit of the target], [m]

FocalPath make_path(const py::object& points, const py::object& pressure, double speed, int patch) {
  const Numbers x = numbers(points, "points", 2);
  const auto n = x.shape(0);
  if (n < 1 || n > kMaxPathPoints || x.shape(1) != 2) {
    throw std::invalid_argument(
        "points has the shape " + std::string(py::str(py::tuple(x.attr("shape")))) +
        "; it must be (n, 2) with n from 1 to " + std::to_string(kMaxPathPoints));
  }
  const bool constant = py::isinstance<py::float_>(pressure) || py::isinstance<py::int_>(pressure);
  const Numbers p = constant ? numbers(pressure, "pressure", 0)
                             : numbers(pressure, "pressure", std::vector<py::ssize_t>{n});
  FocalPath path;
  path.patch = patch;
  for (py::ssize_t i = 0; i < n; ++i) {
    const Vec2 point(x.data()[2 * i], x.data()[2 * i + 1]);
    require_between("a coordinate of points", point.x(), -kLargestCoordinate, kLargestCoordinate,
                    "m");
    require_between("a coordinate of points", point.y(), -kLargestCoordinate, kLargestCoordinate,
                    "m");
    path.points.push_back(point);
    path.pressure.push_back(p.data()[constant ? 0 : i]);
    require_between("pressure", path.pressure.back(), 0.0, kLargestPressure);
  }
  require_between("speed", speed, 1e-3, 1e3, "m/s");
  require_between("patch", patch, 0, kMaxPatches - 1);
  path.length = closed_length(path);
  path.speed = speed;
  path.period = path.length / speed;
  return path;
}

FocalPoint make_focus(const py::object& position, double pressure, int patch, double phase) {
  const Numbers x = numbers(position, "position", std::vector<py::ssize_t>{2});
  const FocalPoint focus{patch, Vec2(x.data()[0], x.data()[1]), pressure, phase};
  for (const double coordinate : focus.position) {
    require_between("a coordinate of position", coordinate, -kLargestCoordinate, kLargestCoordinate,
                    "m");
  }
  require_between("pressure", pressure, 0.0, kLargestPressure);
  require_between("patch", patch, 0, kMaxPatches - 1);
  require_between("phase", phase, 0.0, 1.0);
  return focus;
}

void check_count(std::size_t count, const char* what) {
  if (count <= static_cast<std::size_t>(kMaxPaths)) return;
  throw std::invalid_argument("a plan has " + std::to_string(count) + " " + what +
                              "; it must have at most " + std::to_string(kMaxPaths));
}

Plan make_plan(const std::vector<const FocalPath*>& paths,
               const std::vector<const FocalPoint*>& foci, double loop) {
  check_count(paths.size(), "paths");
  check_count(foci.size(), "foci");
  if (!paths.empty() && !foci.empty())
    throw std::invalid_argument("a plan has paths or foci, not both");
  require_loop(loop);
  if (loop > 0.0 && !foci.empty()) throw std::invalid_argument("a plan of foci has no loop");
  Plan plan;
  plan.loop = loop;
  for (const FocalPoint* focus : foci) {
    if (focus == nullptr) throw py::type_error("a focus must be a FocalPoint, not None");
    plan.foci.push_back(*focus);
  }
  for (const FocalPath* path : paths) {
    if (path == nullptr) throw py::type_error("a path must be a FocalPath, not None");
    plan.paths.push_back(*path);
  }
  return plan;
}

py::array points_of(const py::object& self) {
  static_assert(sizeof(Vec2) == 2 * sizeof(double));
  const auto& points = self.cast<const FocalPath&>().points;
  return view({static_cast<py::ssize_t>(points.size()), 2}, points.data()->data(), self);
}

py::array pressure_of(const py::object& self) {
  const auto& pressure = self.cast<const FocalPath&>().pressure;
  return view({static_cast<py::ssize_t>(pressure.size())}, pressure.data(), self);
}

std::string path_repr(const FocalPath& path) {
  return "FocalPath(" + std::to_string(path.points.size()) +
         " points, length=" + std::string(py::repr(py::float_(path.length))) +
         " m, period=" + std::string(py::repr(py::float_(path.period))) + " s)";
}

py::list paths_of(const py::object& self) {
  py::list paths;
  for (const FocalPath& path : self.cast<const Plan&>().paths) {
    paths.append(py::cast(&path, py::return_value_policy::reference_internal, self));
  }
  return paths;
}

py::list foci_of(const py::object& self) {
  py::list foci;
  for (const FocalPoint& focus : self.cast<const Plan&>().foci) {
    foci.append(py::cast(&focus, py::return_value_policy::reference_internal, self));
  }
  return foci;
}

py::array position_of(const py::object& self) {
  return view({2}, self.cast<const FocalPoint&>().position.data(), self);
}

void bind_focus(py::module_& m) {
  py::class_<FocalPoint>(m, "FocalPoint",
                         "A focal point that stands still in a target's plane, modulated (AM).")
      .def(py::init(&make_focus),
           "position: (2,) in the plane [m]. pressure: rendered pressure at the peak of the\n"
           "modulation, >= 0. patch: index of the target patch (hand). phase: delay of its\n"
           "modulation, as a share of its period, 0 to 1. Raises ValueError, TypeError.",
           py::arg("position"), py::arg("pressure"), py::arg("patch") = 0, py::arg("phase") = 0.0)
      .def_property_readonly("position", &position_of, "(2,) in the plane [m]; a view.")
      .def_readonly("pressure", &FocalPoint::pressure,
                    "Rendered pressure at the peak of the modulation, in the target's unit.")
      .def_readonly("patch", &FocalPoint::patch, "Index of the target patch (hand).")
      .def_readonly("phase", &FocalPoint::phase,
                    "Delay of its modulation, as a share of its period.")
      .def("__repr__",
           [](const py::object& self) {
             const double phase = self.cast<const FocalPoint&>().phase;
             return "FocalPoint(" + std::string(py::repr(self.attr("position").attr("tolist")())) +
                    ", pressure=" + std::string(py::repr(self.attr("pressure"))) +
                    (phase == 0.0 ? "" : ", phase=" + number_text(phase)) + ")";
           })
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(position_of(self), self.attr("pressure"), self.attr("patch"),
                                  self.attr("phase"));
          },
          [](const py::tuple& t) {
            return make_focus(t[0], t[1].cast<double>(), t[2].cast<int>(), t[3].cast<double>());
          }));
}

void bind_classes(py::module_& m) {
  py::class_<FocalPath>(m, "FocalPath",
                        "A closed path of a focal point in a target's plane: the last point joins "
                        "the first.")
      .def(py::init(&make_path),
           "points: (n, 2), n from 1 to 64, in the plane [m].\n"
           "pressure: (n,) rendered at each point, >= 0, or one number for all.\n"
           "speed: speed of the focal point [m/s]. patch: index of the target patch (hand).\n"
           "Length and period follow from these. Raises ValueError, TypeError.",
           py::arg("points"), py::arg("pressure"), py::arg("speed") = PlanSettings{}.speed,
           py::arg("patch") = 0)
      .def_property_readonly("points", &points_of, "(n, 2) points in the plane [m]; a view.")
      .def_property_readonly("pressure", &pressure_of,
                             "(n,) rendered pressure p_i = gain * p*, in the target's unit, linear "
                             "between points; a view.")
      .def_readonly("length", &FocalPath::length, "Length of the closed polygon in the plane [m].")
      .def_readonly("speed", &FocalPath::speed, "Speed of the focal point [m/s].")
      .def_readonly("period", &FocalPath::period,
                    "Duration of a lap [s]: length / speed, or longer where the presets best and "
                    "fast planned for uneven skin.")
      .def_readonly("patch", &FocalPath::patch, "Index of the target patch (hand).")
      .def("__repr__", &path_repr)
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(points_of(self), pressure_of(self), self.attr("speed"),
                                  self.attr("patch"), self.attr("length"), self.attr("period"));
          },
          [](const py::tuple& t) {
            FocalPath path = make_path(t[0], t[1], t[2].cast<double>(), t[3].cast<int>());
            path.length = t[4].cast<double>();
            path.period = t[5].cast<double>();
            return path;
          }));

  py::class_<Plan>(m, "Plan",
                   "A plan for the focal points: at most 8 closed paths, or 8 foci (AM).")
      .def(
          py::init(&make_plan),
          "paths: FocalPaths, or foci: FocalPoints, which are copied. loop: of paths in step, the\n"
          "period in which all come round together [s], 1 ms to 1 s; each then makes whole laps "
          "in\n"
          "it, as many as follow from its speed. 0: each has a period of its own.",
          py::arg("paths") = py::list(), py::arg("foci") = py::list(), py::arg("loop") = 0.0)
      .def_property_readonly("paths", &paths_of, "The FocalPaths, as a new list.")
      .def_property_readonly("foci", &foci_of, "The FocalPoints, as a new list.")
      .def_readonly("loop", &Plan::loop,
                    "Period in which all paths come round together [s]; 0: each on its own.")
      .def("__len__", [](const Plan& plan) { return plan.paths.size() + plan.foci.size(); })
      .def("__repr__",
           [](const py::object& self) {
             const double loop = self.cast<const Plan&>().loop;
             const bool has_foci = !self.cast<const Plan&>().foci.empty();
             return (has_foci ? "Plan(foci=" : "Plan(") +
                    std::string(py::repr(has_foci ? foci_of(self) : paths_of(self))) +
                    (loop == 0.0 ? "" : ", loop=" + number_text(loop)) + ")";
           })
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(paths_of(self), foci_of(self), self.attr("loop"));
          },
          [](const py::tuple& t) {
            return make_plan(t[0].cast<std::vector<const FocalPath*>>(),
                             t[1].cast<std::vector<const FocalPoint*>>(), t[2].cast<double>());
          }));
}

}  // namespace

void check_model(double sigma, const GainLaw& gain, int patch) {
  require_between("sigma", sigma, 1e-4, 0.1, "m");
  require_between("gain", gain.gain, 0.01, 100.0);
  require_between("gain_exponent", gain.exponent, -2.0, 2.0);
  require_between("draw_rate", gain.draw_rate, 0.1, 10'000.0, "Hz");
  require_between("patch", patch, 0, kMaxPatches - 1);
}

py::array quasi_static_array(const Plan& plan, const TargetField& raster, double sigma,
                             const GainLaw& gain, int patch, const SegmentPressures* instead) {
  check_model(sigma, gain, patch);
  py::array_t<double> out({raster.rows, raster.cols});
  const std::span<double> cells(out.mutable_data(), raster.size());
  {
    const py::gil_scoped_release unlocked;
    quasi_static_field(plan, patch, raster, sigma, gain, cells, instead);
  }
  return out;
}

void bind_paths(py::module_& m) {
  m.attr("kMaxPaths") = kMaxPaths;
  m.attr("kMaxPathPoints") = kMaxPathPoints;
  bind_focus(m);
  bind_classes(m);
  m.def("closed_length", &closed_length, "Length of the closed polygon [m].", py::arg("path"));
  m.def(
      "quasi_static_field",
      [](const Plan& plan, const TargetField& raster, double sigma, double gain, int patch,
         double gain_exponent, double draw_rate, bool gain_from_skin) {
        return quasi_static_array(plan, raster, sigma,
                                  {gain, gain_exponent, draw_rate, gain_from_skin}, patch);
      },
      "The paper's Eq. (1): p(x) = p_i / gain * exp(-|x - x_i|^2 / (2 sigma^2)), with x_i the\n"
      "closest point to x over all paths of the patch, or the nearest focus, for which gain is 1\n"
      "(B2). Returns (rows, cols) in the target's\n"
      "unit, for every cell of the raster, skin or not.\n\n"
      "sigma: fall-off of a focal point [m]. gain: rendered over effective pressure, of a path\n"
      "with the period T times (T * draw_rate)**gain_exponent, or with gain_from_skin by (P9c).",
      py::arg("plan"), py::arg("raster"), py::arg("sigma") = PlanSettings{}.sigma,
      py::arg("gain") = PlanSettings{}.gain, py::arg("patch") = 0,
      py::arg("gain_exponent") = PlanSettings{}.gain_exponent,
      py::arg("draw_rate") = PlanSettings{}.draw_rate,
      py::arg("gain_from_skin") = PlanSettings{}.gain_from_skin);
}

}  // namespace prostm::python
