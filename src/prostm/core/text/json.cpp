#include "prostm/core/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/lower_case.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm {
namespace {

constexpr int kMaxDepth = 32;

/// Checks the depth of brackets outside strings before parsing, so that a file of brackets uses no
/// memory.
bool is_too_deep(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxDepth) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

std::string position_text(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

/// Whether the parser stopped at NaN or infinity, which JSON does not have, as printed by Python
/// and JavaScript.
bool stopped_at_no_number(std::string_view text, std::size_t byte) {
  constexpr std::string_view kLetters = "+-abcdefghijklmnopqrstuvwxyz";
  const std::size_t at = byte == 0 ? 0 : byte - 1;
  std::size_t begin = std::min(at, text.size()), end = begin;
  const auto is_letter = [&](std::size_t i) {
    return kLetters.find(lower_case(text.substr(i, 1))) != kLetters.npos;
  };
  while (begin > 0 && is_letter(begin - 1)) --begin;
  while (end < text.size() && is_letter(end)) ++end;
  std::string word = lower_case(text.substr(begin, end - begin));
  if (word.starts_with('-') || word.starts_with('+')) word.erase(0, 1);
  return word == "nan" || word == "inf" || word == "infinity";
}

/// Returns a value for a message: short, and valid text for any file.
std::string shown(const nlohmann::json& value) {
  if (value.is_array()) return "an array";
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 37) + "...";
  return text;
}

bool has_parts(const nlohmann::ordered_json& array) {
  return std::any_of(array.begin(), array.end(),
                     [](const nlohmann::ordered_json& x) { return x.is_structured(); });
}

void append_text(const nlohmann::ordered_json& value, std::size_t indent, std::string& out) {
  const bool spread = value.is_object() ? !value.empty() : value.is_array() && has_parts(value);
  if (!spread) {
    out += value.dump();
    return;
  }
  const std::string margin(indent + 2, ' ');
  out += value.is_object() ? '{' : '[';
  const char* separator = "\n";
  for (const auto& [key, member] : value.items()) {
    out += separator + margin;
    if (value.is_object()) out += nlohmann::ordered_json(key).dump() + ": ";
    append_text(member, indent + 2, out);
    separator = ",\n";
  }
  out += '\n' + std::string(indent, ' ') + (value.is_object() ? '}' : ']');
}

}  // namespace

nlohmann::json parse_json(std::string_view text, const std::string& file) {
  if (const std::string_view kind = kind_by_content(text); !kind.empty() && kind != "JSON") {
    throw InputError(file + ": " + is_not(text, "JSON"));
  }
  if (is_too_deep(text)) {
    throw InputError(fmt::format(
        "{}: is nested deeper than {} levels; no file of this kind needs that", file, kMaxDepth));
  }
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& e) {
    if (e.byte > text.size()) {
      throw InputError(file + ": the JSON ends too early; the file is cut off or incomplete");
    }
    const bool no_number = stopped_at_no_number(text, e.byte);
    throw InputError(fmt::format("{}: is not valid JSON at {}{}", file, position_text(text, e.byte),
                                 no_number ? ": JSON has no NaN and no infinity; write null where "
                                             "there is no value"
                                           : ""));
  } catch (const nlohmann::json::exception& e) {
    // the only other error of the parser is a number outside the range of a double
    const std::string what = e.what();
    const std::size_t quote = what.find('\'');
    throw InputError(fmt::format("{}: the number {} is out of range; numbers must be finite", file,
                                 quote == what.npos ? "" : what.substr(quote, 40)));
  }
}

JsonNode::JsonNode(const nlohmann::json& value, const std::string& file, std::string where)
    : value_(&value), file_(&file), where_(std::move(where)) {}

void JsonNode::fail(const std::string& problem) const {
  throw InputError(
      fmt::format("{}: {} {}", *file_, where_.empty() ? "the document" : where_, problem));
}

bool JsonNode::has(const char* key) const {
  if (!value_->is_object()) return false;
  const auto member = value_->find(key);
  return member != value_->end() && !member->is_null();
}

JsonNode JsonNode::at(const char* key, const char* meaning) const {
  if (!value_->is_object()) fail(fmt::format("is {}; it must be an object", shown(*value_)));
  const std::string where =
      where_.empty() ? fmt::format("\"{}\"", key) : fmt::format("{}.{}", where_, key);
  const auto member = value_->find(key);
  if (member == value_->end()) {
    throw InputError(fmt::format("{}: {} is missing; it must be {}", *file_, where, meaning));
  }
  return {*member, *file_, where};
}

JsonNode JsonNode::at(std::size_t i) const {
  return {(*value_)[i], *file_, fmt::format("{}[{}]", where_, i)};
}

void JsonNode::allow_only(const std::vector<std::string>& known) const {
  if (!value_->is_object()) fail(fmt::format("is {}; it must be an object", shown(*value_)));
  for (const auto& [key, member] : value_->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(fmt::format("{}: {} has no member {}; {}", *file_,
                                 where_.empty() ? "the document" : where_,
                                 shown(nlohmann::json(shown_name(key))), suggestion(key, known)));
  }
}

std::size_t JsonNode::array_size() const {
  if (!value_->is_array()) fail(fmt::format("is {}; it must be an array", shown(*value_)));
  return value_->size();
}

double JsonNode::number(double low, double high) const {
  if (!value_->is_number()) fail(fmt::format("is {}; it must be a number", shown(*value_)));
  const double x = value_->get<double>();
  if (!(x >= low && x <= high)) fail(fmt::format("is {}; it must be from {} to {}", x, low, high));
  return x;
}

int JsonNode::integer(int low, int high) const {
  const double x = value_->is_number() ? value_->get<double>() : 0.5;
  if (x != std::floor(x)) fail(fmt::format("is {}; it must be a whole number", shown(*value_)));
  if (x < low || x > high) fail(fmt::format("is {}; it must be from {} to {}", x, low, high));
  return static_cast<int>(x);
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail(fmt::format("is {}; it must be a string", shown(*value_)));
  return value_->get<std::string>();
}

Vec2 JsonNode::vec2(double low, double high) const {
  if (array_size() != 2) fail(fmt::format("has {} numbers; it must have 2", array_size()));
  return {at(0).number(low, high), at(1).number(low, high)};
}

Vec3 JsonNode::vec3(double low, double high) const {
  if (array_size() != 3) fail(fmt::format("has {} numbers; it must have 3", array_size()));
  return {at(0).number(low, high), at(1).number(low, high), at(2).number(low, high)};
}

void require_format(const JsonNode& root, const char* format) {
  const JsonNode tag = root.at("format", format);
  const std::string found = tag.value().is_string() ? tag.text() : std::string();
  if (found == format) return;
  const std::string_view words = words_of_format(found);
  tag.fail(fmt::format("is {}{}; it must be \"{}\"", shown(tag.value()),
                       words.empty() ? "" : fmt::format(" ({})", words), format));
}

std::string to_text(const nlohmann::ordered_json& document) {
  std::string text;
  append_text(document, 0, text);
  return text + '\n';
}

double to_milli(double x) {
  // 1000 times a very large double overflows
  if (!std::isfinite(x) || std::abs(x) > 1e300) return std::numeric_limits<double>::quiet_NaN();

  // the first that divides back to x: the product with few digits, the product, or its neighbours
  const double product = x * 1000.0;
  const double few_digits = std::strtod(fmt::format("{:.15g}", product).c_str(), nullptr);
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double candidate :
       {few_digits, product, std::nextafter(product, kInf), std::nextafter(product, -kInf)}) {
    if (from_milli(candidate) == x) return candidate;
  }
  return product;
}

nlohmann::ordered_json milli_json(const Vec2& x) {
  return {to_milli(x.x()), to_milli(x.y())};
}
nlohmann::ordered_json milli_json(const Vec3& x) {
  return {to_milli(x.x()), to_milli(x.y()), to_milli(x.z())};
}

}  // namespace prostm
