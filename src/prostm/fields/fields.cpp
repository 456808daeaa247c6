#include "prostm/fields/fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "prostm/core/segment_distance.hpp"
#include "prostm/core/units.hpp"

namespace prostm::fields {
namespace {

Vec2 unit(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

double gaussian(const Vec2& x, double sigma) {
  return std::exp(-0.5 * x.squaredNorm() / (sigma * sigma));
}

/// A smooth step from 1 (x < 0) to 0 (x > 0), about four widths wide.
double step(double x, double width) {
  return 1.0 / (1.0 + std::exp(x / width));
}

const Vec2 kPalm(0.0, -0.035);
constexpr double kPalmRadius = 0.037;

/// Tips of the thumb and the four fingers of the open hand, in a 160 mm square about the origin.
const std::array<Vec2, 5> kTips{Vec2(-0.064, 0.004), Vec2(-0.034, 0.066), Vec2(-0.009, 0.074),
                                Vec2(0.016, 0.068), Vec2(0.040, 0.050)};

/// Returns whether x is on the open hand: a round palm and five fingers.
bool is_hand(const Vec2& x) {
  constexpr double kFingerRadius = 0.0085;
  if ((x - kPalm).norm() <= kPalmRadius) return true;
  return std::any_of(kTips.begin(), kTips.end(), [&](const Vec2& tip) {
    const Vec2 root = kPalm + 0.7 * kPalmRadius * (tip - kPalm).normalized();
    return segment_distance2(x, root, tip) <= kFingerRadius * kFingerRadius;
  });
}

/// Position and shape of a pattern at one instant.
struct Look {
  Vec2 shift = Vec2::Zero();                       // [m]
  double size = 1.0, phase = 0.0, strength = 1.0;  // phase: rotation of the pattern [rad]
  double travel = 0.0;                             // position of the moving edge [m]
};

/// Returns the look of a frame. The pattern moves with the hand by up to 2 mm per frame, the edge
/// sweeps by up to 2.7 mm; each pattern has its own phases.
Look look_at(Pattern pattern, int frame) {
  const double t = kFrameTime * frame, own = 2.4 * static_cast<double>(pattern);
  const auto wave = [&](double hertz, double start) {
    return std::sin(2.0 * kPi * hertz * t + start);
  };
  Look look;
  look.shift = {0.007 * wave(0.31, own) + 0.005 * wave(0.83, 2.1 * own + 1.0),
                0.007 * wave(0.27, 1.7 * own + 2.0) + 0.005 * wave(0.71, 0.6 * own)};
  look.size = 1.0 + 0.15 * wave(0.43, own);
  look.phase = own + 0.5 * t + 0.4 * wave(0.2, own);
  look.strength = 1.1 + 0.6 * wave(0.37, own);
  look.travel = 0.045 * wave(0.24, own);
  return look;
}

double noise(const Vec2& x, const Look& look) {
  // twelve waves in pseudo-random directions, clamped at zero
  double sum = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double wave = 2.0 * kPi / (0.03 + 0.004 * k);
    const double drift = 8.0 * (look.size - 1.0) * (k % 3 - 1);
    sum += std::cos(wave * x.dot(unit(look.phase + 2.4 * k)) + 1.7 * k * k + drift);
  }
  return std::max(sum, 0.0);
}

/// Returns the pressure of a pattern at a point of the hand, without its strength.
double pressure_at(Pattern pattern, const Vec2& point, const Look& look) {
  const Vec2 x = point - look.shift;
  switch (pattern) {
    case Pattern::OnePlume:
      return gaussian(x - Vec2(0.0, -0.01), 0.030 * look.size);
    case Pattern::FourPlumes: {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        sum += gaussian(x - Vec2(0.0, -0.01) - 0.035 * unit(look.phase + 0.5 * kPi * k),
                        0.012 * look.size);
      }
      return sum;
    }
    case Pattern::Ring: {
      const double d = (x - Vec2(0.0, -0.03)).norm() - 0.030 * look.size;
      return std::exp(-0.5 * d * d / (0.007 * 0.007));
    }
    case Pattern::Ridge: {
      const Vec2 half = 0.06 * unit(look.phase), middle(0.0, -0.02);
      return std::exp(-0.5 * segment_distance2(x, middle - half, middle + half) / (0.009 * 0.009));
    }
    case Pattern::Letter: {
      // the letter L
      const Vec2 top(-0.02, 0.02), corner(-0.02, -0.06), end(0.025 * look.size, -0.06);
      const double d2 =
          std::min(segment_distance2(x, top, corner), segment_distance2(x, corner, end));
      return std::exp(-0.5 * d2 / (0.008 * 0.008));
    }
    case Pattern::Noise:
      return noise(x, look);
    case Pattern::Fingertips: {
      // the pads of thumb and index finger slide slightly, pressed alternately
      const Vec2 y = point - 0.3 * look.shift;
      const double share = 0.5 + 0.25 * std::sin(look.phase);
      return share * gaussian(y - kTips[0], 0.007 * look.size) +
             (1.0 - share) * gaussian(y - kTips[1], 0.007 * look.size);
    }
    case Pattern::Palm:
      return step((point - 0.3 * look.shift - kPalm).norm() - 0.031 * look.size, 0.002);
    case Pattern::Edge: {
      const double ahead =
          (point - Vec2(0.0, -0.01)).dot(unit(0.5 * kPi + 0.1 * look.phase)) - look.travel;
      return step(ahead, 0.0015) * std::exp(std::min(ahead, 0.0) / 0.025);
    }
  }
  return 0.0;
}

/// Returns a raster of cells² over `width` about the origin, with `pressure` where `is_skin`.
TargetField raster(int cells, double width, const std::function<bool(const Vec2&)>& is_skin,
                   const std::function<double(const Vec2&)>& pressure) {
  TargetField field;
  field.resize(cells, cells);
  field.cell = width / cells;
  field.origin = Vec2::Constant(-0.5 * field.cell * (cells - 1));
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      const Vec2 x = field.position(row, col);
      if (!is_skin(x)) continue;
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] = pressure(x);
    }
  }
  return field;
}

}  // namespace

std::string to_string(Pattern pattern) {
  constexpr std::array names{"one-plume", "four-plumes",    "ring", "ridge",      "letter",
                             "noise",     "two-fingertips", "palm", "moving-edge"};
  return names[static_cast<std::size_t>(pattern)];
}

TargetField make(Pattern pattern, int frame, int cells) {
  const Look look = look_at(pattern, frame);
  return raster(cells, kCell * kCells, is_hand,
                [&](const Vec2& x) { return look.strength * pressure_at(pattern, x, look); });
}

Vec2 displacement(int frame) {
  constexpr double kRadius = 0.012;
  return kRadius * (unit(2.0 * kPi * frame / 50.0) - unit(0.0));
}

TargetField moved(Pattern pattern, int frame) {
  constexpr double kInner = 0.070, kOuter = 0.085;
  Look look = look_at(pattern, 0);
  look.shift.setZero();
  look.strength = 1.0;
  look.travel = 0.0;
  // relative to the circle's centre, so that the pattern stays away from the raster's border
  const Vec2 shift = displacement(frame) - displacement(25) / 2.0;
  return raster(
      kMovedCells, kCell * kMovedCells, [](const Vec2&) { return true; },
      [&](const Vec2& point) {
        const Vec2 x = point - shift;
        const double u = std::clamp((x.norm() - kInner) / (kOuter - kInner), 0.0, 1.0);
        return 0.5 * (1.0 + std::cos(kPi * u)) * pressure_at(pattern, x, look);
      });
}

Appearing appearing(int which, int frame) {
  struct Contact {
    Vec2 centre;
    double sigma;
  };
  const auto tip = [](int i) { return Contact{kTips[static_cast<std::size_t>(i)], 0.007}; };
  const Contact palm{kPalm, 0.011};
  // pairs 0 to 4: a steady palm, and one of the fingertips appears; then a steady fingertip, and
  // the palm appears
  const Contact steady = which < 5 ? palm : tip(which - 4);
  const Contact second = which < 5 ? tip(which) : palm;
  const Vec2 sway = 0.004 * unit(2.0 * kPi * kFrameTime * frame);  // 1 mm a frame

  Appearing out;
  out.second.assign(static_cast<std::size_t>(kCells) * kCells, 0.0);
  out.field = raster(kCells, kCell * kCells, is_hand, [&](const Vec2& x) {
    return gaussian(x - steady.centre - sway, steady.sigma);
  });
  if (frame < kAppearingFrame) return out;
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const std::size_t i = out.field.index(row, col);
      if (out.field.skin[i] == 0) continue;
      out.second[i] = gaussian(out.field.position(row, col) - second.centre, second.sigma);
      out.field.pressure[i] += out.second[i];
    }
  }
  return out;
}

TargetField rotated(const TargetField& field) {
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
