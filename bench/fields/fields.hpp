#pragma once
/// Generated target fields for benchmarks and tests: pressure patterns on a hand-shaped skin.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/random.hpp"
#include "target/target_field.hpp"

namespace prostm::fields {

inline constexpr int kCells = 80;      ///< rows and columns
inline constexpr double kCell = 2e-3;  ///< edge of a cell [m]

enum class Pattern { OnePlume, FourPlumes, Ring, Ridge, Letter, Noise, Fingertips, Palm };

inline constexpr std::array kPatterns{Pattern::OnePlume,   Pattern::FourPlumes, Pattern::Ring,
                                      Pattern::Ridge,      Pattern::Letter,     Pattern::Noise,
                                      Pattern::Fingertips, Pattern::Palm};

inline std::string to_string(Pattern pattern) {
  constexpr std::array names{"one-plume", "four-plumes", "ring",       "ridge",
                             "letter",    "noise",       "fingertips", "palm"};
  return names[static_cast<std::size_t>(pattern)];
}

/// Squared distance of x from the segment (a, b).
inline double segment_distance2(const Vec2& x, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (x - a - t * ab).squaredNorm();
}

/// Tips of the thumb and the four fingers of the open hand in a 160 mm square about the origin [m].
inline constexpr std::array<std::array<double, 2>, 5> kFingertips{
    {{-0.064, 0.004}, {-0.034, 0.066}, {-0.009, 0.074}, {0.016, 0.068}, {0.040, 0.050}}};

/// An open hand: a round palm and five fingers.
inline bool is_hand(const Vec2& x) {
  constexpr double kPalmRadius = 0.037, kFingerRadius = 0.0085;
  const Vec2 palm(0.0, -0.035);
  if ((x - palm).norm() <= kPalmRadius) return true;
  for (const auto& tip : kFingertips) {
    const Vec2 end(tip[0], tip[1]);
    const Vec2 root = palm + 0.7 * kPalmRadius * (end - palm).normalized();
    if (segment_distance2(x, root, end) <= kFingerRadius * kFingerRadius) return true;
  }
  return false;
}

/// Pressure of a pattern at x, unscaled. `shift` moves the pattern, `size` is about 1, `phase`
/// turns it [rad].
inline double pattern_pressure(Pattern pattern, const Vec2& x, const Vec2& shift, double size,
                               double phase) {
  const auto bump = [&](const Vec2& centre, double sigma) {
    return std::exp(-0.5 * (x - shift - centre).squaredNorm() / (sigma * sigma * size * size));
  };
  const Vec2 along(std::cos(phase), std::sin(phase));
  switch (pattern) {
    case Pattern::OnePlume:
      return bump({0.0, -0.01}, 0.030);
    case Pattern::FourPlumes: {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        const double angle = phase + 0.5 * kPi * k;
        sum += bump(0.035 * Vec2(std::cos(angle), std::sin(angle)) + Vec2(0.0, -0.01), 0.012);
      }
      return sum;
    }
    case Pattern::Ring: {
      const double d = (x - shift - Vec2(0.0, -0.03)).norm() - 0.030 * size;
      return std::exp(-0.5 * d * d / (0.007 * 0.007));
    }
    case Pattern::Ridge: {
      const double d2 = segment_distance2(x - shift, Vec2(0.0, -0.02) - 0.06 * along,
                                          Vec2(0.0, -0.02) + 0.06 * along);
      return std::exp(-0.5 * d2 / (0.009 * 0.009));
    }
    case Pattern::Letter: {
      // an L
      const double d2 = std::min(segment_distance2(x - shift, {-0.02, 0.02}, {-0.02, -0.06}),
                                 segment_distance2(x - shift, {-0.02, -0.06}, {0.025, -0.06}));
      return std::exp(-0.5 * d2 / (0.008 * 0.008));
    }
    case Pattern::Fingertips: {
      double sum = 0.0;
      for (const auto& tip : kFingertips) sum += bump({tip[0], tip[1]}, 0.007);
      return sum;
    }
    case Pattern::Palm:
      return 1.0 / (1.0 + std::exp(((x - shift - Vec2(0.0, -0.035)).norm() - 0.03 * size) / 0.002));
    case Pattern::Noise:
      break;
  }
  // twelve waves of random-looking direction, clamped at zero
  double sum = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double angle = phase + 2.4 * k, wave = 2.0 * kPi / (0.03 + 0.004 * k);
    sum += std::cos(wave * (x - shift).dot(Vec2(std::cos(angle), std::sin(angle))) + 1.7 * k * k);
  }
  return std::max(sum, 0.0);
}

/// One frame of a pattern: `frame` moves, sizes and turns it a little, the same way each time.
/// Pressures are of order 1.
inline TargetField make(Pattern pattern, int frame) {
  Random random(1000003u * static_cast<unsigned>(pattern) + static_cast<unsigned>(frame) + 1u);
  const Vec2 shift(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01));
  const double size = random.uniform(0.85, 1.15), phase = random.uniform(0.0, 2.0 * kPi);
  const double strength = random.uniform(0.5, 2.0);

  TargetField field;
  field.resize(kCells, kCells);
  field.cell = kCell;
  field.origin = Vec2::Constant(-0.5 * kCell * (kCells - 1));
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const Vec2 x = field.position(row, col);
      if (!is_hand(x)) continue;
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] =
          strength * pattern_pressure(pattern, x, shift, size, phase);
    }
  }
  return field;
}

/// The field turned by 90°: cell (row, col) goes to (col, rows − 1 − row), x to (height of the
/// raster − y, x).
inline TargetField rotated(const TargetField& field) {
  TargetField turned;
  turned.resize(field.cols, field.rows);
  turned.cell = field.cell;
  turned.origin = field.origin;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t to = turned.index(col, field.rows - 1 - row);
      turned.pressure[to] = field.pressure[field.index(row, col)];
      turned.skin[to] = field.skin[field.index(row, col)];
      turned.height[to] = field.height[field.index(row, col)];
    }
  }
  return turned;
}

}  // namespace prostm::fields
