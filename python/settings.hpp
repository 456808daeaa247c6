#pragma once
/// Settings in Python, through their visit() alone: a new setting appears as an attribute, a
/// keyword of the constructor, and in the repr.

#include <string>

#include "bindings.hpp"
#include "prostm/core/settings.hpp"

namespace prostm::python {

/// Sets a setting. Messages name the group, e.g. "PlanSettings".
/// @throws std::invalid_argument for an unknown name, py::type_error for a value of another type.
void set_setting(const SettingsGroup& group, const std::string& name, py::handle value);
void set_settings(const SettingsGroup& group, const py::dict& values);
/// All settings by name, in order.
py::dict settings_dict(const SettingsGroup& group);
/// "PlanSettings(preset='paper-valid', paths=4, …)".
std::string settings_repr(const SettingsGroup& group);
/// The lines of a docstring: each name with its default, bounds, unit and meaning.
std::string settings_doc(const SettingsGroup& group);

/// Binds a struct of settings. `doc` is its docstring, to which names and defaults are added.
template <class S>
void bind_settings(py::module_& m, const std::string& type, const std::string& doc) {
  S defaults;
  const std::string whole =
      doc + "\n\nSettings and their defaults:\n" + settings_doc(group_of(type, defaults));
  const auto made = [type](const py::dict& values) {
    S settings;
    set_settings(group_of(type, settings), values);
    return settings;
  };
  py::class_<S>(m, type.c_str(), whole.c_str())
      .def(py::init([made](const py::kwargs& values) { return made(values); }),
           "Every setting is a keyword; omitted settings keep their defaults.\n\n"
           "Raises ValueError for a name that is unknown, TypeError for a value of another type.")
      .def("__getattr__",
           [type](S& self, const std::string& name) -> py::object {
             const py::dict values = settings_dict(group_of("", self));
             if (values.contains(name)) return values[name.c_str()];
             throw py::attribute_error(type + " has no attribute '" + name + "'");
           })
      .def("__setattr__",
           [type](S& self, const std::string& name, const py::object& value) {
             set_setting(group_of(type, self), name, value);
           })
      .def("__dir__",
           [](const py::object& self) {
             py::list names = py::module_::import("builtins").attr("dir")(py::type::of(self));
             for (const auto& item : settings_dict(group_of("", self.cast<S&>()))) {
               names.append(item.first);
             }
             return names;
           })
      .def("__repr__", [type](S& self) { return settings_repr(group_of(type, self)); })
      .def("__eq__",
           [](S& self, const py::object& other) -> py::object {
             if (!py::isinstance<S>(other)) {
               return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             }
             return py::bool_(self == other.cast<S&>());
           })
      .def(
          "as_dict", [](S& self) { return settings_dict(group_of("", self)); },
          "The settings by name, as a new dictionary.")
      .def(
          "copy", [](const S& self) { return S(self); }, "An independent copy.")
      .def("__copy__", [](const S& self) { return S(self); })
      .def("__deepcopy__", [](const S& self, const py::dict&) { return S(self); })
      .def(py::pickle([](S& self) { return settings_dict(group_of("", self)); }, made));
}

}  // namespace prostm::python
