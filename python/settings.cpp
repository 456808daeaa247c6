#include "settings.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace prostm::python {
namespace {

/// Collects names and values.
class Reader : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override { values[s.name] = value; }
  void field(const Setting& s, const int& value) override { values[s.name] = value; }
  void field(const Setting& s, const bool& value) override { values[s.name] = value; }
  void field(const Setting& s, const std::string& value) override { values[s.name] = value; }
  void choice(const Setting& s, std::span<const std::string_view> names, int index) override {
    values[s.name] = std::string(names[static_cast<std::size_t>(index)]);
  }
  py::dict values;
};

/// Collects the lines of a docstring.
class Documentation : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override {
    add(s, py::repr(py::float_(value)), bounds(s));
  }
  void field(const Setting& s, const int& value) override {
    add(s, py::repr(py::int_(value)), bounds(s));
  }
  void field(const Setting& s, const bool& value) override { add(s, value ? "True" : "False", ""); }
  void field(const Setting& s, const std::string& value) override {
    add(s, py::repr(py::str(value)), "");
  }
  void choice(const Setting& s, std::span<const std::string_view> names, int index) override {
    add(s, py::repr(py::str(std::string(names[static_cast<std::size_t>(index)]))),
        "; " + one_of(names));
  }
  std::string text;

 private:
  static std::string bounds(const Setting& s) {
    const std::string text = bounds_text(s);
    return text.empty() ? text : "; " + text;
  }
  void add(const Setting& s, const std::string& value, const std::string& range) {
    text += std::string("  ") + s.name + " = " + value + range + ": " + s.help + "\n";
  }
};

/// Sets the field with a given name.
class Writer : public SettingsWriter {
 public:
  Writer(std::string type, std::string name, py::handle value)
      : type_(std::move(type)), name_(std::move(name)), value_(value) {}

  void field(const Setting& s, double& value) override {
    if (s.name != name_) return;
    const double x = is_bool() ? -1.0 : PyFloat_AsDouble(value_.ptr());
    if (is_bool() || PyErr_Occurred() != nullptr) refuse("a number");
    value = x;
    found = true;
  }
  void field(const Setting& s, int& value) override {
    if (s.name != name_) return;
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
  void field(const Setting& s, bool& value) override {
    if (s.name != name_) return;
    if (!is_bool()) refuse("True or False");
    value = value_.cast<bool>();
    found = true;
  }
  void field(const Setting& s, std::string& value) override {
    if (s.name != name_) return;
    if (!py::isinstance<py::str>(value_)) refuse("a string");
    value = value_.cast<std::string>();
    found = true;
  }
  void choice(const Setting& s, std::span<const std::string_view> names, int& index) override {
    std::string name(names[static_cast<std::size_t>(index)]);
    field(s, name);
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) refuse_name((type_ + "." + name_).c_str(), name, names);
    index = static_cast<int>(at - names.begin());
  }
  bool replaced(const Setting& s) override {
    if (s.name != name_) return false;
    double value = 0.0;
    if (is_bool()) {
      value = value_.cast<bool>() ? 1.0 : 0.0;
      found = true;
    } else {
      field(s, value);
    }
    require_bounds(s, value);
    if (value == 0.0) return false;
    const std::string text = replacement_text(type_, s);
    if (PyErr_WarnEx(PyExc_FutureWarning, text.c_str(), 2) != 0) throw py::error_already_set();
    return true;
  }

  bool found = false;

 private:
  /// Whether the value is Python's or numpy's bool, which would otherwise pass as an integer.
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

py::dict settings_dict(const SettingsGroup& group) {
  Reader reader;
  group.read(reader);
  return reader.values;
}

void set_setting(const SettingsGroup& group, const std::string& name, py::handle value) {
  Writer writer(group.name, name, value);
  group.write(writer);
  if (writer.found) return;

  const py::list known(settings_dict(group).attr("keys")());
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(name, known, 1);
  throw std::invalid_argument(
      group.name + " has no setting '" + name + "'; " +
      (near.empty() ? "known are " + joined(known) : "did you mean '" + joined(near) + "'?"));
}

void set_settings(const SettingsGroup& group, const py::dict& values) {
  // settings that have been replaced come last, since they depend on their replacements
  const py::dict known = settings_dict(group);
  for (const bool replaced : {false, true}) {
    for (const auto& [name, value] : values) {
      if (known.contains(name) != replaced) set_setting(group, name.cast<std::string>(), value);
    }
  }
}

std::string settings_repr(const SettingsGroup& group) {
  std::string text = group.name;
  const char* before = "(";
  for (const auto& [name, value] : settings_dict(group)) {
    text += before + std::string(py::str(name)) + "=" + std::string(py::repr(value));
    before = ", ";
  }
  return text + ")";
}

std::string settings_doc(const SettingsGroup& group) {
  Documentation lines;
  group.read(lines);
  return lines.text;
}

}  // namespace prostm::python
