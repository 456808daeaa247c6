#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "bindings.hpp"
#include "prostm/core/text/number_text.hpp"
#include "prostm/plan/felt_plan.hpp"

namespace prostm::python {
namespace {

SkinSettings make_skin(double slow_speed, double fast_speed, double loss, double density) {
  const SkinSettings skin{slow_speed, fast_speed, loss, density};
  return SkinModel(skin).settings();
}

std::string skin_repr(const SkinSettings& skin) {
  return "SkinSettings(slow_speed=" + number_text(skin.slow_speed) +
         ", fast_speed=" + number_text(skin.fast_speed) + ", loss=" + number_text(skin.loss) +
         ", density=" + number_text(skin.density) + ")";
}

py::tuple values_of(const SkinSettings& skin) {
  return py::make_tuple(skin.slow_speed, skin.fast_speed, skin.loss, skin.density);
}

void bind_skin(py::module_& m) {
  const SkinSettings usual;
  py::class_<SkinSettings>(
      m, "SkinSettings",
      "Properties of the skin in its model (docs/design/skin.md), a soft half-space.\n"
      "Immutable.")
      .def(py::init(&make_skin),
           "slow_speed: of surface waves towards 0 Hz [m/s], 0.5 to 50. fast_speed: their plateau\n"
           "at high frequencies [m/s], slow_speed to 50. loss: tan delta of the tissue's shear\n"
           "modulus at 1 Hz, 0 to 1. density: [kg/m^3], 500 to 2000. Raises ValueError.",
           py::kw_only(), py::arg("slow_speed") = usual.slow_speed,
           py::arg("fast_speed") = usual.fast_speed, py::arg("loss") = usual.loss,
           py::arg("density") = usual.density)
      .def_readonly("slow_speed", &SkinSettings::slow_speed,
                    "Speed of surface waves towards 0 Hz [m/s].")
      .def_readonly("fast_speed", &SkinSettings::fast_speed,
                    "Plateau of their speed at high frequencies [m/s].")
      .def_readonly("loss", &SkinSettings::loss, "tan delta of the shear modulus at 1 Hz.")
      .def_readonly("density", &SkinSettings::density, "Density [kg/m^3].")
      .def("__eq__",
           [](const SkinSettings& self, const py::object& other) -> py::object {
             if (!py::isinstance<SkinSettings>(other)) {
               return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             }
             return py::bool_(values_of(self).equal(values_of(other.cast<const SkinSettings&>())));
           })
      .def("__hash__", [](const SkinSettings& self) { return py::hash(values_of(self)); })
      .def("__repr__", &skin_repr)
      .def(py::pickle(&values_of, [](const py::tuple& t) {
        return make_skin(t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>(),
                         t[3].cast<double>());
      }));
}

py::array view_of(const std::vector<Vec2>& points, py::handle owner) {
  static_assert(sizeof(Vec2) == 2 * sizeof(double));
  return view({static_cast<py::ssize_t>(points.size()), 2}, points.data()->data(), owner);
}

py::array view_of(const std::vector<double>& values, py::handle owner) {
  return view({static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}

/// A list of views, one for each path.
template <class T>
py::list views_by_path(const py::object& self, std::vector<std::vector<T>> FeltPlan::*values) {
  py::list list;
  for (const std::vector<T>& path : self.cast<const FeltPlan&>().*values)
    list.append(view_of(path, self));
  return list;
}

/// A view of one part of every block, which is `columns` numbers wide.
template <class Part>
py::array view_of_blocks(const py::object& self, Part FeltBlock::*part,
                         const std::vector<py::ssize_t>& columns) {
  const auto& blocks = self.cast<const FeltPlan&>().blocks;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(blocks.size())};
  std::vector<py::ssize_t> strides = {static_cast<py::ssize_t>(sizeof(FeltBlock))};
  for (const py::ssize_t count : columns) {
    shape.push_back(count);
    strides.push_back(static_cast<py::ssize_t>(sizeof(double)));
  }
  py::array array(py::dtype::of<double>(), shape, strides, &(blocks.front().*part), self);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// (skins, blocks)
py::array percept_of(const FeltPlan& felt) {
  py::array_t<double> array({felt.percept.size(), felt.blocks.size()});
  double* out = array.mutable_data();
  for (const std::vector<double>& skin : felt.percept)
    out = std::copy(skin.begin(), skin.end(), out);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

void bind_felt_plan(py::module_& m) {
  py::class_<FeltPlan>(
      m, "FeltPlan",
      "The percept of a plan in step by the planner's model of the skin, and the gradient of its\n"
      "lack of quality. Nobody has felt it.")
      .def_readonly("lack", &FeltPlan::lack,
                    "Mean over the skins of 1 - skill_8 + 0.3 (1 - skill_0) of the percept, (W3);\n"
                    "0 is perfect.")
      .def_property_readonly(
          "positions",
          [](const py::object& self) { return view_of_blocks(self, &FeltBlock::position, {2}); },
          "(n, 2) mean places of the n blocks of the target's skin that the model evaluates, in\n"
          "the plane [m]; a view.")
      .def_property_readonly(
          "area", [](const py::object& self) { return view_of_blocks(self, &FeltBlock::area, {}); },
          "(n,) share of each block in the skin, by the target's weights if it has any; they\n"
          "add up to 1; a view.")
      .def_property_readonly(
          "pressure",
          [](const py::object& self) { return view_of_blocks(self, &FeltBlock::pressure, {}); },
          "(n,) mean target pressure of each block over the target's largest; a view.")
      .def_property_readonly(
          "percept", &percept_of,
          "(skins, n) percept of each skin in each block: the rms displacement at 250 Hz that\n"
          "would be felt alike, (S7) [m], for pressures of the plan in Pa; a copy.")
      .def_property_readonly(
          "by_pressure",
          [](const py::object& self) { return views_by_path(self, &FeltPlan::by_pressure); },
          "A list with (points,) for each path: change of lack with each pressure [1 per unit\n"
          "of the pressures]; views.")
      .def_property_readonly(
          "by_point",
          [](const py::object& self) { return views_by_path(self, &FeltPlan::by_point); },
          "A list with (points, 2) for each path: change of lack with the x and y of each point\n"
          "[1/m]; views.")
      .def("__repr__", [](const FeltPlan& felt) {
        return "FeltPlan(lack=" + std::string(py::repr(py::float_(felt.lack))) + ", " +
               std::to_string(felt.blocks.size()) + " blocks, " +
               std::to_string(felt.percept.size()) +
               (felt.percept.size() == 1 ? " skin)" : " skins)");
      });
}

}  // namespace

void bind_felt(py::module_& m) {
  bind_skin(m);
  bind_felt_plan(m);
  m.def("felt_skins", &felt_skins,
        "The three skins that preset felt fits its plans to, as a new list of SkinSettings:\n"
        "waves as fast as those of SkinSettings(), and 0.7 and 1.3 times as fast.");
  m.def(
      "felt_plan",
      [](const Plan& plan, const TargetField& target, double sigma,
         const std::optional<std::vector<SkinSettings>>& skins) {
        const py::gil_scoped_release unlocked;
        return felt_plan(plan, target, sigma, skins ? *skins : felt_skins());
      },
      "The planner's own model of the percept of a plan in step, in double precision: to choose\n"
      "pressures or points of your own. The skin is assumed to be flat.\n\n"
      "plan: a Plan of paths with a loop, like those of preset felt: each path starts "
      "at\n"
      "its first point and makes loop / period laps in a loop, rounded. target:\n"
      "the TargetField that it renders. sigma: fall-off of a focal point [m], 1e-3 to 50e-3.\n"
      "skins: a list of SkinSettings; None: felt_skins().\n\n"
      "Returns a FeltPlan. Raises ValueError for a plan that is not in step, has no path, a\n"
      "path of fewer than 3 points or without length, or no pressure; for a target without\n"
      "pressure; for no skin; for sigma out of bounds.",
      py::arg("plan"), py::arg("target"), py::arg("sigma"), py::arg("skins") = py::none());
}

}  // namespace prostm::python
