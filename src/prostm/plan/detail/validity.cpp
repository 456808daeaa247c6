#include "prostm/plan/detail/validity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/segment_distance.hpp"
#include "prostm/core/units.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm::planning {
namespace {

constexpr int kPushes = 12;              // pushes of 1 mm away from the crossed path
constexpr double kShrink = 0.95;         // factor of one shrinking step
constexpr double kSmallestShare = 0.25;  // least length after shrinking, over max_length

using Loop = std::span<Vec2>;
using ConstLoop = std::span<const Vec2>;

void scale_about(Loop loop, const Vec2& centre, double factor) {
  for (Vec2& x : loop) x = centre + factor * (x - centre);
}

struct Box {
  Vec2 low, high;
  explicit Box(ConstLoop points) : low(points[0]), high(points[0]) {
    for (const Vec2& x : points) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  bool is_apart(const Box& other) const {
    return ((low - other.high).array() > kClearance).any() ||
           ((other.low - high).array() > kClearance).any();
  }
};

/// Reverses sections between crossing segments. Each reversal of properly crossing segments
/// shortens the loop, so this terminates; for segments that only touch it may not, hence the bound
/// on the number of reversals.
void untangle(Loop loop) {
  const std::size_t n = loop.size();
  std::size_t budget = n * n;
  for (bool tangled = true; tangled && budget > 0;) {
    tangled = false;
    for (std::size_t i = 0; i + 2 < n && budget > 0; ++i) {
      for (std::size_t j = i + 2; j < n && budget > 0; ++j) {
        if (i == 0 && j + 1 == n) continue;
        if (!segments_cross(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n])) continue;
        std::reverse(loop.begin() + static_cast<std::ptrdiff_t>(i + 1),
                     loop.begin() + static_cast<std::ptrdiff_t>(j + 1));
        tangled = true;
        --budget;
      }
    }
  }
}

/// The paths accepted so far: the first `count` of `samples` points each in `x`.
struct Accepted {
  ConstLoop x;
  std::size_t samples, count;
  ConstLoop loop(std::size_t k) const { return x.subspan(k * samples, samples); }

  /// Returns the first accepted path that `candidate` crosses, or `count`.
  std::size_t first_crossed(ConstLoop candidate) const {
    for (std::size_t k = 0; k < count; ++k) {
      if (count_crossings(loop(k), candidate) > 0) return k;
    }
    return count;
  }
  bool admits(ConstLoop candidate) const {
    return first_crossed(candidate) == count && is_simple(candidate);
  }
};

/// Pushes the path away from those that it crosses, 1 mm at a time.
bool push_off(const Accepted& accepted, Loop loop) {
  for (int push = 0; push < kPushes; ++push) {
    const std::size_t k = accepted.first_crossed(loop);
    if (k == accepted.count) return is_simple(loop);
    const Vec2 away = centroid(loop) - centroid(accepted.loop(k));
    const double distance = away.norm();
    if (distance < kClearance) return false;
    for (Vec2& x : loop) x += away / distance;
  }
  return accepted.admits(loop);
}

/// Shrinks the path about its centroid until it crosses nothing.
bool shrink_off(const Accepted& accepted, Loop loop, double smallest) {
  const Vec2 centre = centroid(loop);
  for (double length = loop_length(loop); length >= smallest; length *= kShrink) {
    if (accepted.admits(loop)) return true;
    scale_about(loop, centre, kShrink);
  }
  return false;
}

/// Makes `loop` valid together with the accepted paths: untangles and shortens it, then pushes it,
/// shrinks it, or replaces it by a circle, the first that suffices. @return false if none does.
bool fit(const Accepted& accepted, Loop loop, double max_length) {
  untangle(loop);
  shorten(loop, max_length);
  if (accepted.admits(loop)) return true;

  std::array<Vec2, kMaxPathPoints> storage;
  const Loop trial(storage.data(), loop.size());
  const auto accept = [&](bool fits) {
    if (fits) std::copy(trial.begin(), trial.end(), loop.begin());
    return fits;
  };
  std::copy(loop.begin(), loop.end(), trial.begin());
  if (accept(push_off(accepted, trial))) return true;
  std::copy(loop.begin(), loop.end(), trial.begin());
  if (accept(shrink_off(accepted, trial, kSmallestShare * max_length))) return true;
  make_circle(trial, centroid(loop), max_length);
  return accept(shrink_off(accepted, trial, kSmallestShare * max_length));
}

}  // namespace

bool segments_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (std::min(a.x(), b.x()) > std::max(c.x(), d.x()) + kClearance ||
      std::min(c.x(), d.x()) > std::max(a.x(), b.x()) + kClearance ||
      std::min(a.y(), b.y()) > std::max(c.y(), d.y()) + kClearance ||
      std::min(c.y(), d.y()) > std::max(a.y(), b.y()) + kClearance) {
    return false;
  }
  // they cross if each has its ends on different sides of the other
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  if (((c_side > 0.0 && d_side < 0.0) || (c_side < 0.0 && d_side > 0.0)) &&
      ((a_side > 0.0 && b_side < 0.0) || (a_side < 0.0 && b_side > 0.0))) {
    return true;
  }
  // otherwise the shortest distance is at an end
  return std::min({segment_distance2(a, c, d), segment_distance2(b, c, d),
                   segment_distance2(c, a, b), segment_distance2(d, a, b)}) <
         kClearance * kClearance;
}

Vec2 centroid(ConstLoop loop) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& x : loop) sum += x;
  return sum / static_cast<double>(loop.size());
}

void shorten(Loop loop, double most_length) {
  const double length = loop_length(loop);
  if (length > most_length) scale_about(loop, centroid(loop), most_length / length);
}

void make_circle(Loop loop, const Vec2& centre, double length) {
  const auto n = static_cast<double>(loop.size());
  const double radius = length / (2.0 * n * std::sin(kPi / n));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / n;
    loop[i] = centre + radius * Vec2(std::cos(angle), std::sin(angle));
  }
}

double loop_length(std::span<const Vec2> loop) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < loop.size(); ++i) length += (loop[i + 1] - loop[i]).norm();
  return length + (loop.front() - loop.back()).norm();
}

int count_self_crossings(std::span<const Vec2> loop) {
  int count = 0;
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t j = i + 2; j + 1 < n; ++j) {
      count += segments_cross(loop[i], loop[i + 1], loop[j], loop[j + 1]) ? 1 : 0;
    }
    // the last segment is the first one's neighbour
    if (i > 0) count += segments_cross(loop[i], loop[i + 1], loop[n - 1], loop[0]) ? 1 : 0;
  }
  return count;
}

int count_crossings(std::span<const Vec2> a, std::span<const Vec2> b) {
  if (Box(a).is_apart(Box(b))) return 0;
  int count = 0;
  for (std::size_t i = a.size() - 1, next = 0; next < a.size(); i = next++) {
    for (std::size_t j = b.size() - 1, after = 0; after < b.size(); j = after++) {
      count += segments_cross(a[i], a[next], b[j], b[after]) ? 1 : 0;
    }
  }
  return count;
}

bool folds_back(std::span<const Vec2> loop) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0, last = n - 1; i < n; last = i++) {
    const Vec2 &before = loop[last], &x = loop[i], &after = loop[i + 1 < n ? i + 1 : 0];
    if (std::min(segment_distance2(after, before, x), segment_distance2(before, x, after)) <
        kClearance * kClearance) {
      return true;
    }
  }
  return false;
}

bool is_simple(std::span<const Vec2> loop) {
  return !folds_back(loop) && count_self_crossings(loop) == 0;
}

int make_valid(std::span<Vec2> x, int samples, double max_length) {
  const auto n = static_cast<std::size_t>(samples);
  Accepted accepted{x, n, 0};
  for (std::size_t begin = 0; begin < x.size(); begin += n) {
    const Loop loop = x.subspan(begin, n);
    if (!fit(accepted, loop, max_length)) continue;
    std::copy(loop.begin(), loop.end(),
              x.begin() + static_cast<std::ptrdiff_t>(accepted.count * n));
    ++accepted.count;
  }
  return static_cast<int>(accepted.count);
}

}  // namespace prostm::planning
