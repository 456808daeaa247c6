#include "plan/spacing.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"
#include "plan/distances.hpp"
#include "plan/validity.hpp"

namespace prostm::planning {
namespace {

constexpr int kRounds = 60;         // of pushing apart
constexpr double kPushGoal = 1.02;  // pushed samples get this times the spacing
constexpr double kRounding = 1e-6;  // of single precision, several times over

using Loop = std::span<Vec2>;
using ConstLoop = std::span<const Vec2>;

/// Arc length of each sample of each path, and the paths' lengths.
struct Measures {
  std::array<double, static_cast<std::size_t>(kMaxPaths) * kMaxPathPoints> at;
  std::array<double, kMaxPaths> length{};

  Measures(ConstLoop x, std::size_t n) {
    for (std::size_t k = 0; k * n < x.size(); ++k) {
      const ConstLoop loop = x.subspan(k * n, n);
      for (std::size_t i = 0; i < n; ++i) {
        at[k * n + i] = length[k];
        length[k] += (loop[i + 1 < n ? i + 1 : 0] - loop[i]).norm();
      }
    }
  }
};

/// Calls visit(a, b, distance) for the pairs of samples that are nearer than `reach` and count. It
/// may move the samples: those that this brings near enough are for the next time.
template <typename Visit>
void for_near_pairs(ConstLoop x, std::size_t n, double reach, double along, const Visit& visit) {
  const Measures measured(x, n);
  // in single precision with a margin for its rounding, then exactly
  alignas(64) NodeArray rough_x{}, rough_y{};
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    rough_x[i] = static_cast<float>(x[i].x());
    rough_y[i] = static_cast<float>(x[i].y());
    largest = std::max(largest, x[i].cwiseAbs().maxCoeff());
  }
  const auto rough_reach = static_cast<float>(reach + kRounding * (reach + largest));
  NodeList near;
  for (std::size_t a = 0; a < x.size(); ++a) {
    nodes_near(rough_x, rough_y, x.size(), a, rough_reach, near);
    for (std::size_t i = 0; i < near.count; ++i) {
      const auto b = static_cast<std::size_t>(near.node[i]);
      const double squared = (x[b] - x[a]).squaredNorm();
      if (squared >= reach * reach) continue;
      if (a / n == b / n) {
        const double apart = measured.at[b] - measured.at[a];
        if (std::min(apart, measured.length[a / n] - apart) <= along) continue;
      }
      visit(a, b, std::sqrt(squared));
    }
  }
}

bool crosses_any(ConstLoop x, std::size_t n, ConstLoop loop) {
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    if (count_crossings(x.subspan(begin, n), loop) > 0) return true;
  }
  return false;
}

bool is_valid(ConstLoop x, std::size_t n, const SpacingRule& rule) {
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    const ConstLoop loop = x.subspan(begin, n);
    if (loop_length(loop) > rule.most_length[begin / n] * (1.0 + 1e-9) || !is_simple(loop))
      return false;
    if (crosses_any(x.first(begin), n, loop)) return false;
  }
  return count_near_pairs(x, static_cast<int>(n), rule) == 0;
}

/// Moves samples that are too near away from each other until none is, or the rounds end.
void push_apart(Loop x, std::size_t n, const SpacingRule& rule) {
  const double goal = kPushGoal * rule.spacing;
  for (int round = 0; round < kRounds; ++round) {
    bool near = false;
    for_near_pairs(x, n, goal, rule.along, [&](std::size_t a, std::size_t b, double distance) {
      near = near || distance < rule.spacing;
      // coinciding samples part along x
      const Vec2 way = distance > 1e-6 ? Vec2((x[b] - x[a]) / distance) : Vec2(1.0, 0.0);
      const Vec2 push = 0.5 * (goal - distance) * way;
      x[a] -= push;
      x[b] += push;
    });
    for (std::size_t begin = 0; begin < x.size(); begin += n) {
      shorten(x.subspan(begin, n), rule.most_length[begin / n]);
    }
    if (!near) return;
  }
}

/// Keeps the paths that are valid beside those before, as they are or as circles.
std::size_t keep_valid(Loop x, std::size_t n, SpacingRule rule) {
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    const Loop place = x.subspan(kept, n);
    const Vec2 centre = centroid(x.subspan(begin, n));
    rule.most_length[kept / n] = rule.most_length[begin / n];
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(begin), n, place.begin());
    bool valid = is_valid(x.first(kept + n), n, rule);
    if (!valid) {
      make_circle(place, centre, std::min(rule.least_length, rule.most_length[kept / n]));
      valid = kept == 0 || is_valid(x.first(kept + n), n, rule);
    }
    if (valid) kept += n;
  }
  return kept;
}

}  // namespace

int count_near_pairs(std::span<const Vec2> x, int samples, const SpacingRule& rule) {
  int count = 0;
  for_near_pairs(x, static_cast<std::size_t>(samples), rule.spacing, rule.along,
                 [&](std::size_t, std::size_t, double) { ++count; });
  return count;
}

int make_spaced(std::span<Vec2> x, int samples, const SpacingRule& rule) {
  const auto n = static_cast<std::size_t>(samples);
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    shorten(x.subspan(begin, n), rule.most_length[begin / n]);
  }
  if (is_valid(x, n, rule)) return static_cast<int>(x.size() / n);
  push_apart(x, n, rule);
  if (is_valid(x, n, rule)) return static_cast<int>(x.size() / n);
  return static_cast<int>(keep_valid(x, n, rule) / n);
}

}  // namespace prostm::planning
