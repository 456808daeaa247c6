#include "prostm/core/require.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "prostm/core/text/number_text.hpp"

namespace prostm {
namespace {

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
  refuse(name, number_text(value), number_text(low), number_text(high), unit);
}

void require_between(const char* name, int value, int low, int high, const char* unit) {
  if (value >= low && value <= high) return;
  refuse(name, std::to_string(value), std::to_string(low), std::to_string(high), unit);
}

}  // namespace prostm
