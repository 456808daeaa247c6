#pragma once
/// Colours of the figures. Private to figure.

#include <cstddef>

namespace prostm::figure {

struct Colour {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;  ///< sRGB, 0..1; a = 0 is clear
};

inline constexpr Colour kInk{0.13, 0.14, 0.16};
inline constexpr Colour kFaintInk{0.42, 0.44, 0.47};
inline constexpr Colour kPaper{1.0, 1.0, 1.0};
inline constexpr Colour kNoSkin{0.93, 0.93, 0.93};
inline constexpr Colour kSkin{0.84, 0.84, 0.86};
inline constexpr Colour kWarning{0.80, 0.20, 0.10};

Colour mix(const Colour& from, const Colour& to, double share);

/// The colour map of all fields: lightness increases uniformly from dark violet to yellow, so that
/// equal steps in value look equal, also in greyscale. Built in Oklab (B. Ottosson, "A perceptual
/// color space for image processing", 2020) with L = 0.24 + 0.70 t, hue 305° to 102°, and the
/// largest chroma within sRGB along the way.
Colour field_colour(double t);

/// The colour of path i, distinguishable with any colour vision (M. Okabe and K. Ito, "Color
/// universal design", 2008).
Colour path_colour(std::size_t i);

}  // namespace prostm::figure
