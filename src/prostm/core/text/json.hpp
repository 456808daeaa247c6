#pragma once
/// Reading JSON with clear error messages, and writing it, for all JSON files and messages.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/geometry.hpp"

namespace prostm {

/// More than any field needs: 10⁶ cells with pressure and height at full precision.
inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;

/// @throws InputError with line and column: not JSON, truncated, nested deeper than 32 levels, a
/// number beyond the range of a double.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// A value of a document with its location, for error messages. Refers to the document and the
/// file's name, which must outlive it. All functions throw InputError.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, const std::string& file, std::string where = {});

  const nlohmann::json& value() const { return *value_; }
  const std::string& file() const { return *file_; }
  bool has(const char* key) const;  ///< whether this object has such a member that is not null
  /// @param meaning completes "it must be …" if the member is missing.
  JsonNode at(const char* key, const char* meaning) const;
  JsonNode at(std::size_t i) const;
  /// Refuses members that are not in `known`, since a misspelt optional member would be silently
  /// ignored.
  void allow_only(const std::vector<std::string>& known) const;
  std::size_t array_size() const;
  double number(double low, double high) const;
  int integer(int low, int high) const;
  std::string text() const;
  Vec2 vec2(double low, double high) const;
  Vec3 vec3(double low, double high) const;

  /// Throws "<file>: <where> <problem>".
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  const nlohmann::json* value_;
  const std::string* file_;
  std::string where_;
};

/// @throws InputError unless the document is an object with "format": `format`.
void require_format(const JsonNode& root, const char* format);

/// The document as text: each member on its own line, arrays of numbers on one line, matrices row
/// by row. Numbers have the fewest digits that read back the same; non-finite numbers are null.
std::string to_text(const nlohmann::ordered_json& document);

/// Converts to thousandths for files (m to mm, s to ms), with the fewest digits that read back as
/// the same value, if such a double exists.
double to_milli(double x);
inline double from_milli(double thousandths) {
  return thousandths / 1000.0;
}
inline Vec3 from_milli(const Vec3& thousandths) {
  return thousandths / 1000.0;
}
nlohmann::ordered_json milli_json(const Vec2& x);
nlohmann::ordered_json milli_json(const Vec3& x);

}  // namespace prostm
