#pragma once
/// How a stage's settings are listed once, and read, written, checked and documented from that one
/// list.
///
/// Each `XxxSettings` has `visit()`, which names its fields in order with what they mean. Names in
/// files are the names in C++, values are SI as in C++. Files, the command line and Python know
/// settings through this interface alone.

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
  const char* unit = "";  ///< "m/s"; empty for a plain number or no number
  double least = -std::numeric_limits<double>::infinity();  ///< of a number, in its unit
  double most = std::numeric_limits<double>::infinity();
  const char* help = "";    ///< one clause, without the unit and the bounds
  bool names_file = false;  ///< of a text: the name of a file that is read, unless it is empty
};

/// Sees every field and may change it.
class SettingsWriter {
 public:
  virtual ~SettingsWriter() = default;
  virtual void field(const Setting& setting, double& value) = 0;
  virtual void field(const Setting& setting, int& value) = 0;
  virtual void field(const Setting& setting, bool& value) = 0;
  virtual void field(const Setting& setting, std::string& value) = 0;
  /// One of several names, by its place.
  virtual void choice(const Setting& setting, std::span<const std::string_view> names,
                      int& index) = 0;

  template <class E>
  requires std::is_enum_v<E>
  void field(const Setting& setting, E& value) {
    int index = static_cast<int>(value);
    choice(setting, kNames<E>, index);
    value = static_cast<E>(index);
  }
};

/// Sees every field.
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
  WriteSettings write;  ///< none of a group that is only to be read
};

/// The settings of one struct, or of several under one name; they outlive it.
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

/// The bounds of a number in words, with its unit: "0.1 to 100 m/s", "at least 0", or nothing.
std::string bounds_text(const Setting& setting);

/// A setting as it is listed.
struct SettingRow {
  Setting setting;
  const char* type;   ///< of its value in a settings file: float, integer, boolean or string
  std::string value;  ///< as a settings file has it: 0.0086, 4, true, "best"
  std::string
      bounds;  ///< "0.1 to 100 m/s", "true or false", "best, fast or paper"; empty for a text
  std::vector<std::string_view> choices = {};  ///< all values of a choice, empty for other settings
};
/// Every setting, in order.
std::vector<SettingRow> setting_rows(const ReadSettings& settings);

/// A setting that names a file which is read.
struct SettingFile {
  std::string setting, path;
};
/// Those that are not empty, in order.
std::vector<SettingFile> files_of(const ReadSettings& settings);

/// Checks a number against the setting's bounds. @throws std::invalid_argument with the sentence of
/// require_between().
void require_bounds(const Setting& setting, double value);
void require_bounds(const Setting& setting, int value);
/// Checks every number. @throws std::invalid_argument about the first that is out of its bounds.
void require_bounds(const ReadSettings& settings);
template <class Settings>
void require_bounds(const Settings& settings) {
  require_bounds(ReadSettings([&settings](SettingsReader& v) { settings.visit(v); }));
}

}  // namespace prostm
