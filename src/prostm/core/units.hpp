#pragma once
/// Unit literals for numbers from the literature. Everything inside prostm is SI.

#include <numbers>

namespace prostm {

inline constexpr double kPi = std::numbers::pi;

namespace literals {
constexpr double operator""_mm(long double x) {
  return static_cast<double>(x) * 1e-3;
}  // [m]
constexpr double operator""_mm(unsigned long long x) {
  return static_cast<double>(x) * 1e-3;
}  // [m]
constexpr double operator""_ms(long double x) {
  return static_cast<double>(x) * 1e-3;
}  // [s]
constexpr double operator""_ms(unsigned long long x) {
  return static_cast<double>(x) * 1e-3;
}  // [s]
constexpr double operator""_kHz(unsigned long long x) {
  return static_cast<double>(x) * 1e3;
}  // [Hz]
}  // namespace literals

}  // namespace prostm
