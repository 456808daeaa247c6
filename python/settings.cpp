#include "settings.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace prostm::python {
namespace {

/// Collects names and values.
class Reader : public SettingsVisitor {
 public:
  void field(const char* name, double& value) override { values[name] = value; }
  void field(const char* name, int& value) override { values[name] = value; }
  void field(const char* name, bool& value) override { values[name] = value; }
  void field(const char* name, std::string& value) override { values[name] = value; }
  py::dict values;
};

/// Sets the one field of a name.
class Writer : public SettingsVisitor {
 public:
  Writer(std::string type, std::string name, py::handle value)
      : type_(std::move(type)), name_(std::move(name)), value_(value) {}

  void field(const char* name, double& value) override {
    if (name != name_) return;
    const double x = is_bool() ? -1.0 : PyFloat_AsDouble(value_.ptr());
    if (is_bool() || PyErr_Occurred() != nullptr) refuse("a number");
    value = x;
    found = true;
  }
  void field(const char* name, int& value) override {
    if (name != name_) return;
    if (is_bool() || PyIndex_Check(value_.ptr()) == 0) refuse("a whole number");
    const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value_.ptr()));
    if (!number) refuse("a whole number");
    int overflow = 0;
    const long x = PyLong_AsLongAndOverflow(number.ptr(), &overflow);
    if (overflow != 0 || x < std::numeric_limits<int>::min() ||
        x > std::numeric_limits<int>::max()) {
      throw std::invalid_argument(type_ + "." + name_ + " must lie within 32 bits, not " +
                                  std::string(py::str(number)));
    }
    value = static_cast<int>(x);
    found = true;
  }
  void field(const char* name, bool& value) override {
    if (name != name_) return;
    if (!is_bool()) refuse("True or False");
    value = value_.cast<bool>();
    found = true;
  }
  void field(const char* name, std::string& value) override {
    if (name != name_) return;
    if (!py::isinstance<py::str>(value_)) refuse("a text");
    value = value_.cast<std::string>();
    found = true;
  }

  bool found = false;

 private:
  /// Python's or numpy's; both pass for the whole numbers 0 and 1 otherwise.
  bool is_bool() const {
    return py::isinstance<py::bool_>(value_) ||
           std::string(Py_TYPE(value_.ptr())->tp_name) == "numpy.bool_";
  }
  [[noreturn]] void refuse(const char* right) const {
    PyErr_Clear();
    throw py::type_error(type_ + "." + name_ + " must be " + right + ", not " +
                         std::string(py::repr(value_)));
  }

  std::string type_, name_;
  py::handle value_;
};

std::string joined(const py::list& names) {
  return py::str(py::str(", ").attr("join")(names));
}

}  // namespace

py::dict settings_dict(const Visit& visit) {
  Reader reader;
  visit(reader);
  return reader.values;
}

void set_setting(const Visit& visit, const std::string& type, const std::string& name,
                 py::handle value) {
  Writer writer(type, name, value);
  visit(writer);
  if (writer.found) return;

  const py::list known(settings_dict(visit).attr("keys")());
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(name, known, 1);
  throw std::invalid_argument(
      type + " has no setting '" + name + "'; " +
      (near.empty() ? "known are " + joined(known) : "did you mean '" + joined(near) + "'?"));
}

void set_settings(const Visit& visit, const std::string& type, const py::dict& values) {
  for (const auto& [name, value] : values) {
    set_setting(visit, type, name.cast<std::string>(), value);
  }
}

std::string settings_repr(const Visit& visit, const std::string& type) {
  std::string text = type;
  const char* before = "(";
  for (const auto& [name, value] : settings_dict(visit)) {
    text += before + std::string(py::str(name)) + "=" + std::string(py::repr(value));
    before = ", ";
  }
  return text + ")";
}

std::string settings_doc(const Visit& visit) {
  std::string text;
  for (const auto& [name, value] : settings_dict(visit)) {
    text += "  " + std::string(py::str(name)) + " = " + std::string(py::repr(value)) + "\n";
  }
  return text;
}

}  // namespace prostm::python
