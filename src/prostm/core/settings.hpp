#pragma once
/// Settings of stages: each is listed once, and read, written, checked and documented from that
/// list.
///
/// Each `XxxSettings` has `visit()`, which lists its fields in order with their meanings. Names and
/// values in files are those in C++, in SI. Files, the command line and Python access settings only
/// through this interface.

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// A field's description, without its value.
struct Setting {
  const char* name;
  const char* unit = "";  ///< "m/s"; empty if dimensionless or not a number
  double least = -std::numeric_limits<double>::infinity();  ///< bounds of a number, in its unit
  double most = std::numeric_limits<double>::infinity();
  const char* help = "";    ///< one clause, without the unit and the bounds
  bool names_file = false;  ///< for a text: the name of a file to read, if not empty
};

/// Visits every field and may change it.
class SettingsWriter {
 public:
  virtual ~SettingsWriter() = default;
  virtual void field(const Setting& setting, double& value) = 0;
  virtual void field(const Setting& setting, int& value) = 0;
  virtual void field(const Setting& setting, bool& value) = 0;
  virtual void field(const Setting& setting, std::string& value) = 0;
  /// Visits one of several names, by index.
  virtual void choice(const Setting& setting, std::span<const std::string_view> names,
                      int& index) = 0;
  /// Visits a setting of earlier versions, a number or a boolean that `setting.help` has replaced.
  /// @return whether it is given and neither 0 nor false.
  virtual bool replaced(const Setting& /*setting*/) { return false; }

  template <class E>
  requires std::is_enum_v<E>
  void field(const Setting& setting, E& value) {
    int index = static_cast<int>(value);
    choice(setting, kNames<E>, index);
    value = static_cast<E>(index);
  }
};

/// Visits every field.
class SettingsReader {
 public:
  virtual ~SettingsReader() = default;
  virtual void field(const Setting& setting, const double& value) = 0;
  virtual void field(const Setting& setting, const int& value) = 0;
  virtual void field(const Setting& setting, const bool& value) = 0;
  virtual void field(const Setting& setting, const std::string& value) = 0;
  virtual void choice(const Setting& setting, std::span<const std::string_view> names,
                      int index) = 0;

  template <class E>
  requires std::is_enum_v<E>
  void field(const Setting& setting, const E& value) {
    choice(setting, kNames<E>, static_cast<int>(value));
  }
};

using ReadSettings = std::function<void(SettingsReader&)>;
using WriteSettings = std::function<void(SettingsWriter&)>;

/// A stage's settings under its name in files.
struct SettingsGroup {
  std::string name;
  ReadSettings read;
  WriteSettings write;  ///< empty for a read-only group
};

/// Returns the settings of one or more structs under one name; they must outlive the group.
template <class... Settings>
SettingsGroup group_of(std::string name, Settings&... settings) {
  SettingsGroup group;
  group.name = std::move(name);
  group.read = [&settings...](SettingsReader& v) { (std::as_const(settings).visit(v), ...); };
  if constexpr ((!std::is_const_v<Settings> && ...)) {
    group.write = [&settings...](SettingsWriter& v) { (settings.visit(v), ...); };
  }
  return group;
}

/// Returns the sentence that a setting of earlier versions has been replaced, without a full stop.
std::string replacement_text(const std::string& group, const Setting& setting);

/// The bounds of a number in words, with its unit: "0.1 to 100 m/s", "at least 0", or nothing.
std::string bounds_text(const Setting& setting);

/// A row in a list of settings.
struct SettingRow {
  Setting setting;
  const char* type;   ///< type of its value in a settings file: float, integer, boolean or string
  std::string value;  ///< as in a settings file: 0.0086, 4, true, "best"
  std::string
      bounds;  ///< "0.1 to 100 m/s", "true or false", "best, fast or paper"; empty for a text
  std::vector<std::string_view> choices = {};  ///< all values of a choice, empty for other settings
};
/// Every setting, in order.
std::vector<SettingRow> setting_rows(const ReadSettings& settings);

/// A setting that names a file to read.
struct SettingFile {
  std::string setting, path;
};
/// Returns the non-empty ones, in order.
std::vector<SettingFile> files_of(const ReadSettings& settings);

/// Checks a number against the setting's bounds. @throws std::invalid_argument with the sentence of
/// require_between().
void require_bounds(const Setting& setting, double value);
void require_bounds(const Setting& setting, int value);
/// Checks every number. @throws std::invalid_argument for the first that is out of bounds.
void require_bounds(const ReadSettings& settings);
template <class Settings>
void require_bounds(const Settings& settings) {
  require_bounds(ReadSettings([&settings](SettingsReader& v) { settings.visit(v); }));
}

}  // namespace prostm
