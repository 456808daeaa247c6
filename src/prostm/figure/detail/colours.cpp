#include "prostm/figure/detail/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm::figure {
namespace {

double gamma_encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double cubed(double x) {
  return x * x * x;
}

/// Linear sRGB of an Oklab colour; may lie outside 0..1.
std::array<double, 3> linear_srgb(double lightness, double a, double b) {
  const double l = cubed(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cubed(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cubed(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

}  // namespace

Colour mix(const Colour& from, const Colour& to, double share) {
  const auto between = [&](double x, double y) { return x + share * (y - x); };
  return {between(from.r, to.r), between(from.g, to.g), between(from.b, to.b),
          between(from.a, to.a)};
}

Colour field_colour(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const double lightness = 0.24 + 0.70 * t;
  const double hue = (305.0 - 203.0 * t) * kPi / 180.0;

  // the largest chroma up to 0.16 within sRGB
  double chroma = 0.16;
  std::array<double, 3> rgb{};
  for (;; chroma -= 0.002) {
    rgb = linear_srgb(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
    const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
    if ((*low >= -0.001 && *high <= 1.001) || chroma < 0.002) break;
  }
  return {gamma_encoded(rgb[0]), gamma_encoded(rgb[1]), gamma_encoded(rgb[2])};
}

Colour path_colour(std::size_t i) {
  static constexpr std::array<Colour, 8> kColours{{{0.835, 0.369, 0.000},
                                                   {0.000, 0.447, 0.698},
                                                   {0.000, 0.620, 0.451},
                                                   {0.800, 0.475, 0.655},
                                                   {0.902, 0.624, 0.000},
                                                   {0.337, 0.706, 0.914},
                                                   {0.350, 0.250, 0.200},
                                                   {0.750, 0.700, 0.100}}};
  return kColours[i % kColours.size()];
}

}  // namespace prostm::figure
