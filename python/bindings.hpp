#pragma once
/// The parts of the module `prostm`, one function for each source file, and what they share.
///
/// Conventions: the names of C++, SI units; lengths in millimetres only where a name ends in _mm.
/// Fields, paths and plans do not change once made. So arrays are views of their memory, and the
/// interpreter's lock can be released while they are read.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/quantity.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::python {

namespace py = pybind11;

void bind_target(py::module_& m);
void bind_paths(py::module_& m);
void bind_plan(py::module_& m);
void bind_planners(py::module_& m);
void bind_result(py::module_& m);
void bind_score(py::module_& m);
void bind_felt(py::module_& m);
void bind_emit(py::module_& m);
void bind_io(py::module_& m);
void bind_shape(py::module_& m);
void bind_recording(py::module_& m);

/// Describes a value in a message: "None", "3", "'palm'", else its type, "an array".
std::string described(py::handle value);

/// Returns the patches of a TargetField or a TargetFrame. @throws py::type_error for anything else.
std::vector<const TargetField*> patches_of(py::handle target);
/// Largest pressure of a TargetField or a TargetFrame; 0 without skin.
double largest_pressure(py::handle target);

/// Returns the options for reading a field's file, under their Python names.
FieldFileOptions file_options(std::optional<double> cell_mm, std::optional<double> width_mm,
                              std::optional<int> frame, bool invert);
/// Reads the field if a target is given by the name of a file; returns other targets as they are.
/// @throws InputError as read_field() does, std::invalid_argument for options without a file.
py::object target_of(const py::object& target, const FieldFileOptions& options);

/// Numbers given by the user: any array or nested sequence of booleans, integers or floats, as
/// doubles in rows.
/// @throws py::type_error if it holds no numbers, std::invalid_argument unless it has `dimensions`
/// dimensions.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
inline constexpr std::size_t kMostNumbers = 100'000'000;
Numbers numbers(py::handle value, const std::string& name, int dimensions,
                std::size_t most = kMostNumbers);

/// The same with an exact shape, e.g. {2} for a point.
Numbers numbers(py::handle value, const std::string& name, const std::vector<py::ssize_t>& shape);

/// A read-only array on memory that `owner` keeps alive. T is double, or bool for 0 and 1 in bytes.
py::array view(const py::dtype& type, const std::vector<py::ssize_t>& shape, const void* data,
               py::handle owner);
py::array view(const std::vector<py::ssize_t>& shape, const double* data, py::handle owner);

/// The pose as a homogeneous 4 × 4 matrix, and back (its last row must be 0 0 0 1).
py::array pose_matrix(const Pose& pose);
Pose pose_from(py::handle matrix, const std::string& name);

/// Binds a struct of results: its fields as attributes, in a repr and as a dictionary.
template <class S>
class Record {
 public:
  Record(py::module_& m, const char* name, const char* doc) : class_(m, name, doc) {}

  template <class T>
  Record& field(const char* name, T S::*member, const char* doc) {
    class_.def_readonly(name, member, doc);
    names_.append(name);
    return *this;
  }
  /// Adds all quantities of S, in SI units.
  Record& quantities() {
    for (const Quantity<S>& quantity : prostm::quantities<S>()) {
      class_.def_property_readonly(
          quantity.name,
          [&quantity](const S& self) {
            return visit_value(quantity, self, [](auto value) { return py::cast(value); });
          },
          quantity.help);
      names_.append(quantity.name);
      if (quantity.optional) optional_.append(quantity.name);
    }
    return *this;
  }
  /// Call last.
  void done() {
    const py::tuple names(names_), optional(optional_);
    class_.def(
        "as_dict",
        [names, optional](const py::object& self) {
          py::dict values;
          for (const py::handle name : names) {
            const py::object value = self.attr(name);
            if (!optional.contains(name) || !std::isnan(value.cast<double>())) values[name] = value;
          }
          return values;
        },
        "The fields by name, as a new dictionary, without those that were not requested (NaN).");
    class_.def("__repr__", [names](const py::object& self) {
      std::string text = py::str(py::type::of(self).attr("__name__"));
      const char* before = "(";
      for (const py::handle name : names) {
        text += before + std::string(py::str(name)) + "=" + std::string(py::repr(self.attr(name)));
        before = ", ";
      }
      return text + ")";
    });
  }

 private:
  py::class_<S> class_;
  py::list names_, optional_;
};

}  // namespace prostm::python
