#include "prostm/core/require.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace prostm {
namespace {

/// Returns the shortest text that reads back as the same number.
std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general);
  return {text.data(), end.ptr};
}

[[noreturn]] void refuse(const std::string& name, const std::string& value, const std::string& low,
                         const std::string& high, const std::string& unit) {
  const std::string space_and_unit = unit.empty() ? "" : " " + unit;
  throw std::invalid_argument(name + " = " + value + space_and_unit + " must be between " + low +
                              " and " + high + space_and_unit);
}

}  // namespace

void require_between(const char* name, double value, double low, double high, const char* unit) {
  // NaN is refused before it is compared: the comparison would trap
  if (std::isfinite(value) && value >= low && value <= high) return;
  refuse(name, shortest(value), shortest(low), shortest(high), unit);
}

void require_between(const char* name, int value, int low, int high, const char* unit) {
  if (value >= low && value <= high) return;
  refuse(name, std::to_string(value), std::to_string(low), std::to_string(high), unit);
}

}  // namespace prostm
