#include "prostm/fields/felt_fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/segment_distance.hpp"
#include "prostm/core/units.hpp"

namespace prostm::fields {
namespace {

using Pattern2 = std::function<double(const Vec2&)>;
using Line = std::vector<Vec2>;

Vec2 unit(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

double gaussian(double distance2, double sigma) {
  return std::exp(-0.5 * distance2 / (sigma * sigma));
}

/// A smooth step from 1 (x < 0) to 0 (x > 0), about 10 mm wide.
double step(double x) {
  constexpr double kWidth = 2.5e-3;  // [m]
  return 1.0 / (1.0 + std::exp(x / kWidth));
}

/// Returns a ridge along open lines of points [m].
Pattern2 ridge(std::vector<Line> lines, double sigma) {
  return [lines = std::move(lines), sigma](const Vec2& x) {
    double least = 1.0;
    for (const Line& line : lines) {
      for (std::size_t i = 1; i < line.size(); ++i)
        least = std::min(least, segment_distance2(x, line[i - 1], line[i]));
    }
    return gaussian(least, sigma);
  };
}

/// Returns `count` equal blobs, evenly spaced on a circle.
Pattern2 plumes(int count, double radius, double sigma) {
  return [=](const Vec2& x) {
    double sum = 0.0;
    for (int k = 0; k < count; ++k)
      sum += gaussian((x - radius * unit(2.0 * kPi * k / count)).squaredNorm(), sigma);
    return sum;
  };
}

std::vector<Line> strokes(int letter, double half) {
  const auto at = [&](double x, double y) { return Vec2(half * x, half * y); };
  switch (letter) {
    case 0:
      return {{at(-1, 1), at(1, 1)}, {at(0, 1), at(0, -1)}};
    case 1:
      return {{at(-1, 1), at(-1, -1)}, {at(1, 1), at(1, -1)}, {at(-1, 0), at(1, 0)}};
    case 2:
      return {{at(-1, 1), at(0, -1), at(1, 1)}};
    default:
      return {{at(-1, 1), at(1, 1), at(-1, -1), at(1, -1)}};
  }
}

Line spiral(double reach) {
  constexpr int kPoints = 48;
  Line line;
  for (int i = 0; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    line.push_back(reach * (0.1 + 0.9 * share) * unit(3.3 * kPi * share));
  }
  return line;
}

Pattern2 speckle(Random& random) {
  struct Spot {
    Vec2 at;
    double sigma, strength;
  };
  std::vector<Spot> spots(static_cast<std::size_t>(10 + random.below(7)));
  for (Spot& spot : spots) {
    // one after the other, so that no compiler changes their order
    spot.at.y() = random.uniform(-0.06, 0.06);
    spot.at.x() = random.uniform(-0.05, 0.05);
    spot.sigma = random.uniform(4e-3, 8e-3);
    spot.strength = random.uniform(0.3, 1.0);
  }
  return [spots](const Vec2& x) {
    double sum = 0.0;
    for (const Spot& spot : spots)
      sum += spot.strength * gaussian((x - spot.at).squaredNorm(), spot.sigma);
    return sum;
  };
}

/// Returns a pattern of kFeltKinds about the origin [m].
Pattern2 seen_pattern(FeltKind kind, Random& random) {
  const double a = random.uniform(), b = random.uniform();
  switch (kind) {
    case FeltKind::Plume:
      return plumes(1, 0.0, 0.012 + 0.010 * a);
    case FeltKind::TwoPlumes:
      return plumes(2, 0.021 + 0.009 * a, 0.007 + 0.004 * b);
    case FeltKind::ThreePlumes:
      return plumes(3, 0.022 + 0.009 * a, 0.007 + 0.004 * b);
    case FeltKind::FourPlumes:
      return plumes(4, 0.025 + 0.008 * a, 0.007 + 0.003 * b);
    case FeltKind::Circle:
      return [radius = 0.020 + 0.010 * a, sigma = 0.005 + 0.002 * b](const Vec2& x) {
        const double d = x.norm() - radius;
        return gaussian(d * d, sigma);
      };
    case FeltKind::Cross: {
      const double half = 0.030 + 0.010 * a;
      return ridge({{Vec2(-half, 0.0), Vec2(half, 0.0)}, {Vec2(0.0, -half), Vec2(0.0, half)}},
                   0.005 + 0.002 * b);
    }
    case FeltKind::Gradient:
      return [width = 0.06 + 0.04 * a](const Vec2& x) {
        return std::clamp(0.5 + x.x() / width, 0.0, 1.0);
      };
    case FeltKind::Stripe:
      return [sigma = 0.006 + 0.004 * a](const Vec2& x) { return gaussian(x.x() * x.x(), sigma); };
    case FeltKind::Front:
      return [](const Vec2& x) { return step(x.x()); };
    case FeltKind::Strokes:
      return ridge(strokes(random.below(4), 0.022 + 0.008 * a), 0.005 + 0.002 * b);
    case FeltKind::BlobPair:
      return [apart = 0.040 + 0.015 * a, weak = 0.4 + 0.25 * b](const Vec2& x) {
        const Vec2 half(0.5 * apart, 0.0);
        return gaussian((x - half).squaredNorm(), 0.008) +
               weak * gaussian((x + half).squaredNorm(), 0.012);
      };
    default:
      return speckle(random);
  }
}

Pattern2 moat(double radius) {
  return [radius](const Vec2& x) {
    const double r = x.norm(), trench = step(std::abs(r - 0.5 * radius) - 0.17 * radius);
    return step(r - radius) * (1.0 - trench);
  };
}

Pattern2 steps(double width, double middle, double low) {
  return [=](const Vec2& x) {
    const double first = step(x.x() + 0.5 * width), second = step(x.x() - 0.5 * width);
    const double within = step(std::abs(x.x()) - 1.5 * width);
    return within * ((1.0 - middle) * first + (middle - low) * second + low);
  };
}

Pattern2 comb(double apart, double second, double third) {
  return [=](const Vec2& x) {
    const double ends = step(std::abs(x.y()) - 0.035);
    const auto bar = [&](double at) { return gaussian((x.x() - at) * (x.x() - at), 0.0055); };
    return ends * (bar(-apart) + second * bar(0.0) + third * bar(apart));
  };
}

/// Returns a pattern of kUnseenKinds about the origin [m].
Pattern2 unseen_pattern(FeltKind kind, Random& random) {
  const double a = random.uniform(), b = random.uniform();
  switch (kind) {
    case FeltKind::Spiral:
      return ridge({spiral(0.034 + 0.008 * a)}, 0.005);
    case FeltKind::Crescent:
      return [radius = 0.028 + 0.008 * a, shift = 0.014 + 0.008 * b](const Vec2& x) {
        return step(x.norm() - radius) * (1.0 - step((x - Vec2(shift, 0.0)).norm() - radius));
      };
    case FeltKind::Checkerboard:
      return [wave = 2.0 * kPi / (0.050 + 0.014 * a), b](const Vec2& x) {
        return std::max(std::sin(wave * x.x() + kPi * b) * std::sin(wave * x.y()), 0.0);
      };
    case FeltKind::Zigzag: {
      const double w = 0.016 + 0.004 * a, h = 0.020 + 0.008 * b;
      return ridge({{Vec2(-2 * w, -h), Vec2(-w, h), Vec2(0, -h), Vec2(w, h), Vec2(2 * w, -h)}},
                   0.0055);
    }
    case FeltKind::Triangle: {
      const double r = 0.030 + 0.010 * a;
      const Vec2 p = r * unit(0.0), q = r * unit(2.1 + 0.3 * b), s = r * unit(4.2 - 0.3 * b);
      return ridge({{p, q, s, p}}, 0.0055);
    }
    case FeltKind::Moat:
      return moat(0.034 + 0.008 * a);
    case FeltKind::Steps:
      return steps(0.022 + 0.006 * a, 0.5 + 0.2 * b, 0.2);
    default:
      return comb(0.021 + 0.007 * a, 0.4 + 0.2 * b, 0.7);
  }
}

/// Returns a random blob, bar or arc.
Pattern2 drawn_part(Random& random) {
  Vec2 at;
  at.y() = random.uniform(-0.030, 0.030);
  at.x() = random.uniform(-0.022, 0.022);
  const double strength = random.uniform(0.4, 1.0), sigma = random.uniform(0.005, 0.009),
               size = random.uniform(), from = random.uniform(0.0, 2.0 * kPi);
  const auto scaled = [strength](Pattern2 pattern) -> Pattern2 {
    return [=](const Vec2& x) { return strength * pattern(x); };
  };
  switch (random.below(3)) {
    case 0:
      return scaled([at, wide = (1.0 + size) * sigma](const Vec2& x) {
        return gaussian((x - at).squaredNorm(), wide);
      });
    case 1: {
      const Vec2 half = (0.010 + 0.025 * size) * unit(from);
      return scaled(ridge({{at - half, at + half}}, sigma));
    }
    default: {
      constexpr int kPoints = 24;
      const double radius = 0.012 + 0.014 * size, turn = random.uniform(0.8 * kPi, 2.0 * kPi);
      Line arc;
      for (int i = 0; i <= kPoints; ++i)
        arc.push_back(at + radius * unit(from + turn * i / kPoints));
      return scaled(ridge({arc}, sigma));
    }
  }
}

/// Returns a pattern of kDrawnKinds about the origin [m].
Pattern2 drawn_pattern(Random& random) {
  std::vector<Pattern2> parts(static_cast<std::size_t>(1 + random.below(4)));
  for (Pattern2& part : parts) part = drawn_part(random);
  return [parts](const Vec2& x) {
    double most = 0.0;
    for (const Pattern2& part : parts) most = std::max(most, part(x));
    return most;
  };
}

/// Returns a pattern of a kind about the origin [m].
Pattern2 pattern_of(FeltKind kind, Random& random) {
  if (std::ranges::find(kDrawnKinds, kind) != kDrawnKinds.end()) return drawn_pattern(random);
  if (std::ranges::find(kUnseenKinds, kind) != kUnseenKinds.end())
    return unseen_pattern(kind, random);
  return seen_pattern(kind, random);
}

/// Returns the centre of the palm of an outline [m].
Vec2 palm_of(Outline outline) {
  return outline == Outline::Hand ? Vec2(0.0, -0.040) : Vec2(0.0, 0.0);
}

bool is_skin(Outline outline, const Vec2& x) {
  if (outline == Outline::Palm)
    return std::pow(x.x() / 0.038, 2) + std::pow(x.y() / 0.048, 2) <= 1.0;
  const Vec2 palm = (x - palm_of(outline)).cwiseAbs() - Vec2(0.030, 0.038);
  if (palm.cwiseMax(0.0).norm() <= 0.012) return true;
  struct Finger {
    Vec2 root, tip;
  };
  static const std::array<Finger, 5> kFingers{Finger{Vec2(-0.033, -0.005), Vec2(-0.038, 0.052)},
                                              Finger{Vec2(-0.011, 0.000), Vec2(-0.012, 0.078)},
                                              Finger{Vec2(0.011, 0.000), Vec2(0.012, 0.074)},
                                              Finger{Vec2(0.032, -0.008), Vec2(0.036, 0.046)},
                                              Finger{Vec2(-0.030, -0.050), Vec2(-0.044, -0.012)}};
  return std::any_of(kFingers.begin(), kFingers.end(), [&](const Finger& f) {
    return segment_distance2(x, f.root, f.tip) <= 0.009 * 0.009;
  });
}

TargetField raster_of(Outline outline) {
  TargetField field;
  const bool hand = outline == Outline::Hand;
  field.resize(hand ? 36 : 24, hand ? 21 : 24);
  field.cell = hand ? 5e-3 : 4e-3;
  field.origin = -0.5 * field.cell * Vec2(field.cols - 1, field.rows - 1);
  for (std::size_t c = 0; c < field.size(); ++c)
    field.skin[c] = is_skin(outline, field.position(c)) ? 1 : 0;
  return field;
}

}  // namespace

std::string to_string(FeltKind kind) {
  constexpr std::array names{
      "plume",        "two plumes", "three plumes", "four plumes", "circle",  "cross",  "gradient",
      "stripe",       "front",      "strokes",      "blob pair",   "speckle", "spiral", "crescent",
      "checkerboard", "zigzag",     "triangle",     "moat",        "steps",   "comb",   "drawn"};
  return names[static_cast<std::size_t>(kind)];
}

std::string to_string(Outline outline) {
  return outline == Outline::Hand ? "hand" : "palm";
}

TargetField felt_field(FeltKind kind, std::uint64_t seed, Outline outline) {
  Random random(1000 * seed + static_cast<std::uint64_t>(kind));
  const Pattern2 pattern = pattern_of(kind, random);
  constexpr double kAside = 0.010;  // largest distance from the palm's centre [m]
  Vec2 centre = palm_of(outline);
  centre.y() += random.uniform(-kAside, kAside);
  centre.x() += random.uniform(-kAside, kAside);
  const double angle = random.uniform(0.0, 2.0 * kPi);
  const Vec2 along = unit(angle), across(-along.y(), along.x());
  TargetField field = raster_of(outline);
  for (std::size_t c = 0; c < field.size(); ++c) {
    const Vec2 x = field.position(c) - centre;
    if (field.skin[c] != 0) field.pressure[c] = pattern(Vec2(x.dot(along), x.dot(across)));
  }
  const double largest = max_pressure(field);
  for (double& p : field.pressure) p /= largest;
  return field;
}

}  // namespace prostm::fields
