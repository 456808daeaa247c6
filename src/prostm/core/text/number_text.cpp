#include "prostm/core/text/number_text.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace prostm {

std::string number_text(double value) {
  // whole numbers are more readable without an exponent, unless they have many digits
  constexpr double kLongest = 1e10;
  const bool whole =
      std::isfinite(value) && std::abs(value) < kLongest && value == std::trunc(value);
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 whole ? std::chars_format::fixed : std::chars_format::general);
  std::string text(digits.data(), end.ptr);
  // shortens 1e+06 and 1e-06 to 1e6 and 1e-6
  std::size_t exponent = text.find('e');
  if (exponent++ == text.npos) return text;
  if (text[exponent] == '+') text.erase(exponent, 1);
  if (text[exponent] == '-') ++exponent;
  text.erase(exponent, text.find_first_not_of('0', exponent) - exponent);
  return text;
}

ComparedText compared_text(double value, double bound, int decimals) {
  constexpr int kMost = 17;
  const auto with = [&](double number, int digits) {
    return fmt::format("{:.{}f}", number, digits);
  };
  const bool differ = value != bound;
  ComparedText text{with(value, decimals), with(bound, decimals)};
  while (differ && text.value == text.bound && decimals < kMost) {
    ++decimals;
    text = {with(value, decimals), with(bound, decimals)};
  }
  return text;
}

}  // namespace prostm
