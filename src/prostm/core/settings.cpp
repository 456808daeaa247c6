#include "prostm/core/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/text/number_text.hpp"

namespace prostm {
namespace {

int to_int(double bound) {
  return static_cast<int>(
      std::clamp<double>(bound, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

class FileCollector : public SettingsReader {
 public:
  void field(const Setting&, const double&) override {}
  void field(const Setting&, const int&) override {}
  void field(const Setting&, const bool&) override {}
  void field(const Setting& s, const std::string& value) override {
    if (s.names_file && !value.empty()) files.push_back({s.name, value});
  }
  void choice(const Setting&, std::span<const std::string_view>, int) override {}
  std::vector<SettingFile> files;
};

class BoundsCheck : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override { require_bounds(s, value); }
  void field(const Setting& s, const int& value) override { require_bounds(s, value); }
  void field(const Setting&, const bool&) override {}
  void field(const Setting&, const std::string&) override {}
  void choice(const Setting&, std::span<const std::string_view>, int) override {}
};

/// A text quoted as in TOML and JSON.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

class RowCollector : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override {
    rows.push_back({s, "float", number_text(value), bounds_text(s)});
  }
  void field(const Setting& s, const int& value) override {
    rows.push_back({s, "integer", std::to_string(value), bounds_text(s)});
  }
  void field(const Setting& s, const bool& value) override {
    rows.push_back({s, "boolean", value ? "true" : "false", "true or false"});
  }
  void field(const Setting& s, const std::string& value) override {
    rows.push_back({s, "string", in_quotes(value), ""});
  }
  void choice(const Setting& s, std::span<const std::string_view> names, int index) override {
    const std::vector<std::string_view> choices(names.begin(), names.end());
    rows.push_back(
        {s, "string", in_quotes(names[static_cast<std::size_t>(index)]), one_of(names), choices});
  }
  std::vector<SettingRow> rows;
};

}  // namespace

std::string replacement_text(const std::string& group, const Setting& setting) {
  return group + "." + setting.name + " was replaced by " + setting.help + ", which is used";
}

std::string bounds_text(const Setting& setting) {
  const bool below = std::isfinite(setting.least), above = std::isfinite(setting.most);
  if (!below && !above) return "";
  const std::string least = number_text(setting.least), most = number_text(setting.most);
  const std::string range = !above   ? "at least " + least
                            : !below ? "at most " + most
                                     : least + " to " + most;
  return *setting.unit == '\0' ? range : range + " " + setting.unit;
}

std::vector<SettingRow> setting_rows(const ReadSettings& settings) {
  RowCollector collector;
  settings(collector);
  return collector.rows;
}

std::vector<SettingFile> files_of(const ReadSettings& settings) {
  FileCollector collector;
  settings(collector);
  return collector.files;
}

void require_bounds(const Setting& s, double value) {
  require_between(s.name, value, s.least, s.most, s.unit);
}

void require_bounds(const Setting& s, int value) {
  require_between(s.name, value, to_int(s.least), to_int(s.most), s.unit);
}

void require_bounds(const ReadSettings& settings) {
  BoundsCheck check;
  settings(check);
}

}  // namespace prostm
