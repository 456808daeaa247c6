#include "prostm/plan/detail/fit/spacing.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/plan/detail/fit/raster/distances.hpp"
#include "prostm/plan/detail/validity.hpp"

namespace prostm::planning {
namespace {

constexpr int kRounds = 60;         // rounds of pushing apart
constexpr double kPushGoal = 1.02;  // distance that samples are pushed to, over the spacing
constexpr double kSlack = 0.7;      // move of a sample after which near pairs are listed again [mm]
constexpr double kRounding = 1e-4;  // relative margin, far above single-precision rounding

using Loop = std::span<Vec2>;
using ConstLoop = std::span<const Vec2>;

/// Path and arc length of each sample, and the paths' lengths.
struct Measures {
  std::array<std::uint8_t, kMaxLoopNodes> path;
  std::array<double, kMaxLoopNodes> at;
  std::array<double, kMaxPaths> length{};

  Measures(ConstLoop x, std::size_t n) {
    for (std::size_t k = 0; k * n < x.size(); ++k) {
      const ConstLoop loop = x.subspan(k * n, n);
      for (std::size_t i = 0; i < n; ++i) {
        path[k * n + i] = static_cast<std::uint8_t>(k);
        at[k * n + i] = length[k];
        length[k] += (loop[i + 1 < n ? i + 1 : 0] - loop[i]).norm();
      }
    }
  }
  /// Distance along the path of both samples, the shorter way.
  double between(const NodePair& pair) const {
    const double apart = at[pair.second] - at[pair.first];
    return std::min(apart, length[path[pair.first]] - apart);
  }
};

/// Calls visit(a, b, distance) for the pairs of samples that the rule covers and that are nearer
/// than `reach`. visit may move the samples; pairs that become near by this are left to the next
/// call.
template <typename Visit>
void for_near_pairs(ConstLoop x, std::size_t n, double reach, double along, NearSamples& near,
                    const Visit& visit) {
  near.list(x, n, reach, along);
  const auto visit_if_near = [&](const NodePair& pair) {
    const double squared = (x[pair.second] - x[pair.first]).squaredNorm();
    if (squared < reach * reach) visit(pair.first, pair.second, std::sqrt(squared));
  };
  if (near.own().size() > 0) {
    const Measures measured(x, n);
    for (std::size_t i = 0; i < near.own().size(); ++i) {
      if (measured.between(near.own()[i]) > along) visit_if_near(near.own()[i]);
    }
  }
  for (std::size_t i = 0; i < near.across().size(); ++i) visit_if_near(near.across()[i]);
}

/// Returns whether any non-adjacent segments cross. The midpoints of two crossing segments are at
/// most half the sum of their lengths apart.
bool has_crossings(ConstLoop x, std::size_t n, NodePairs& near) {
  alignas(64) NodeArray middle_x{}, middle_y{};
  std::array<std::uint16_t, kMaxLoopNodes> next;
  double longest2 = 0.0;
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    for (std::size_t a = begin; a < begin + n; ++a) {
      const std::size_t b = a + 1 < begin + n ? a + 1 : begin;
      const Vec2 middle = 0.5 * (x[a] + x[b]) - x[0];
      middle_x[a] = static_cast<float>(middle.x());
      middle_y[a] = static_cast<float>(middle.y());
      next[a] = static_cast<std::uint16_t>(b);
      longest2 = std::max(longest2, (x[b] - x[a]).squaredNorm());
    }
  }
  near.set(middle_x, middle_y, x.size(),
           static_cast<float>(std::sqrt(longest2) * (1.0 + kRounding) + kClearance));
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto [s, t] = near[i];
    if (next[s] == t || next[t] == s) continue;
    if (segments_cross(x[s], x[next[s]], x[t], x[next[t]])) return true;
  }
  return false;
}

bool is_valid(ConstLoop x, std::size_t n, const SpacingRule& rule, SpacingScratch& scratch) {
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    const ConstLoop loop = x.subspan(begin, n);
    if (loop_length(loop) > rule.most_length[begin / n] * (1.0 + 1e-9) || folds_back(loop)) {
      return false;
    }
  }
  return are_apart(x, static_cast<int>(n), rule, scratch) && !has_crossings(x, n, scratch.segments);
}

/// Pushes samples that are too near apart, until no pair is too near or for kRounds rounds.
void push_apart(Loop x, std::size_t n, const SpacingRule& rule, SpacingScratch& scratch) {
  const double goal = kPushGoal * rule.spacing;
  for (int round = 0; round < kRounds; ++round) {
    bool any = false;
    for_near_pairs(x, n, goal, rule.along, scratch.samples,
                   [&](std::size_t a, std::size_t b, double distance) {
                     any = any || distance < rule.spacing;
                     // coinciding samples are separated along x
                     const Vec2 way =
                         distance > 1e-6 ? Vec2((x[b] - x[a]) / distance) : Vec2(1.0, 0.0);
                     const Vec2 push = 0.5 * (goal - distance) * way;
                     x[a] -= push;
                     x[b] += push;
                   });
    for (std::size_t begin = 0; begin < x.size(); begin += n) {
      shorten(x.subspan(begin, n), rule.most_length[begin / n]);
    }
    if (!any) return;
  }
}

/// Keeps the paths that are valid together with those already kept, unchanged or as circles.
std::size_t keep_valid(Loop x, std::size_t n, SpacingRule rule, SpacingScratch& scratch) {
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    const Loop place = x.subspan(kept, n);
    const Vec2 centre = centroid(x.subspan(begin, n));
    rule.most_length[kept / n] = rule.most_length[begin / n];
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(begin), n, place.begin());
    bool valid = is_valid(x.first(kept + n), n, rule, scratch);
    if (!valid) {
      make_circle(place, centre, std::min(rule.least_length, rule.most_length[kept / n]));
      valid = kept == 0 || is_valid(x.first(kept + n), n, rule, scratch);
    }
    if (valid) kept += n;
  }
  return kept;
}

}  // namespace

bool NearSamples::is_listed(std::span<const Vec2> x, std::size_t n, double reach,
                            double along) const {
  if (listed_at_.size() != x.size() || n_ != n || along_ != along) return false;
  if (std::abs(reach_ - reach) > kSlack) return false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if ((x[i] - listed_at_[i]).squaredNorm() > kSlack * kSlack) return false;
  }
  return true;
}

void NearSamples::list(std::span<const Vec2> x, std::size_t n, double reach, double along) {
  if (is_listed(x, n, reach, along)) return;
  listed_at_.assign(x.begin(), x.end());
  n_ = n;
  reach_ = reach;
  along_ = along;
  alignas(64) NodeArray rough_x{}, rough_y{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    rough_x[i] = static_cast<float>(x[i].x() - x[0].x());
    rough_y[i] = static_cast<float>(x[i].y() - x[0].y());
  }
  // margin: both samples may move by the slack, and the next reach may be larger by it
  across_.set(rough_x, rough_y, x.size(),
              static_cast<float>((reach + 3.0 * kSlack) * (1.0 + kRounding)));
  // distances along a path change, too: each segment between may grow by the slack at both ends
  const Measures measured(x, n);
  own_.clear();
  across_.filter([&](const NodePair& pair) {
    const std::size_t path = measured.path[pair.first], gap = pair.second - pair.first;
    if (path != measured.path[pair.second]) return true;
    const double apart = measured.at[pair.second] - measured.at[pair.first];
    const double growth = 2.0 * kSlack * static_cast<double>(gap),
                 growth_round = 2.0 * kSlack * static_cast<double>(n - gap);
    if (apart + growth > along && measured.length[path] - apart + growth_round > along)
      own_.add(pair);
    return false;
  });
}

int count_near_pairs(std::span<const Vec2> x, int samples, const SpacingRule& rule) {
  int count = 0;
  NearSamples near;
  for_near_pairs(x, static_cast<std::size_t>(samples), rule.spacing, rule.along, near,
                 [&](std::size_t, std::size_t, double) { ++count; });
  return count;
}

bool are_apart(std::span<const Vec2> x, int samples, const SpacingRule& rule,
               SpacingScratch& scratch) {
  bool near = false;
  for_near_pairs(x, static_cast<std::size_t>(samples), rule.spacing, rule.along, scratch.samples,
                 [&](std::size_t, std::size_t, double) { near = true; });
  return !near;
}

int make_spaced(std::span<Vec2> x, int samples, const SpacingRule& rule, SpacingScratch& scratch) {
  const auto n = static_cast<std::size_t>(samples);
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    shorten(x.subspan(begin, n), rule.most_length[begin / n]);
  }
  if (is_valid(x, n, rule, scratch)) return static_cast<int>(x.size() / n);
  push_apart(x, n, rule, scratch);
  if (is_valid(x, n, rule, scratch)) return static_cast<int>(x.size() / n);
  return static_cast<int>(keep_valid(x, n, rule, scratch) / n);
}

}  // namespace prostm::planning
