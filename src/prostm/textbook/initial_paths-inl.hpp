/// Path initialisation of the textbook planner: plain Lloyd, plain 2-opt, midpoint splits. Part of
/// kernel.cpp, which compiles it once per instruction set.

// clang-format off
#if defined(PROSTM_TEXTBOOK_INITIAL_PATHS) == defined(HWY_TARGET_TOGGLE)
#ifdef PROSTM_TEXTBOOK_INITIAL_PATHS
#undef PROSTM_TEXTBOOK_INITIAL_PATHS
#else
#define PROSTM_TEXTBOOK_INITIAL_PATHS
#endif
// clang-format on

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

HWY_BEFORE_NAMESPACE();
namespace prostm::textbook {
namespace HWY_NAMESPACE {
namespace {

/// Weighted points of the plane [mm].
struct Points {
  std::vector<double> x, y, weight;
  std::size_t size() const { return x.size(); }
};

using Tour = std::vector<int>;

double distance(const Points& p, int a, int b) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return std::sqrt((p.x[i] - p.x[j]) * (p.x[i] - p.x[j]) + (p.y[i] - p.y[j]) * (p.y[i] - p.y[j]));
}

void shuffle(Tour& order, Random& random) {
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  }
}

double mass(const Points& p, const Tour& tour) {
  double sum = 0.0;
  for (const int c : tour) sum += p.weight[static_cast<std::size_t>(c)];
  return sum;
}

/// Weighted mean and unit vector of largest spread.
struct Axis {
  double mean_x = 0, mean_y = 0, x = 1, y = 0;
  Axis(const Points& p, const Tour& tour) {
    double xx = 0, xy = 0, yy = 0;
    const double total = mass(p, tour);
    for (const int c : tour) {
      const auto i = static_cast<std::size_t>(c);
      mean_x += p.weight[i] * p.x[i] / total;
      mean_y += p.weight[i] * p.y[i] / total;
    }
    for (const int c : tour) {
      const auto i = static_cast<std::size_t>(c);
      const double dx = p.x[i] - mean_x, dy = p.y[i] - mean_y;
      xx += p.weight[i] * dx * dx;
      xy += p.weight[i] * dx * dy;
      yy += p.weight[i] * dy * dy;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    x = std::cos(angle);
    y = std::sin(angle);
  }
  double along(const Points& p, int c) const {
    const auto i = static_cast<std::size_t>(c);
    return (p.x[i] - mean_x) * x + (p.y[i] - mean_y) * y;
  }
  double across(const Points& p, int c) const {
    const auto i = static_cast<std::size_t>(c);
    return (p.y[i] - mean_y) * x - (p.x[i] - mean_x) * y;
  }
};

/// Assigns every point to its nearest centre. @return whether any label changed.
bool assign(const Points& p, const Points& centres, std::vector<int>& label) {
  bool changed = false;
  const std::size_t k = centres.size();
  for (std::size_t i = 0; i < p.size(); ++i) {
    double best = HUGE_VAL;
    int nearest = 0;
    for (std::size_t c = 0; c < k; ++c) {
      const double dx = p.x[i] - centres.x[c], dy = p.y[i] - centres.y[c], d2 = dx * dx + dy * dy;
      if (d2 < best) {
        best = d2;
        nearest = static_cast<int>(c);
      }
    }
    changed = changed || label[i] != nearest;
    label[i] = nearest;
  }
  return changed;
}

/// Moves the centres to the weighted means; a centre without points stays.
void update(const Points& p, const std::vector<int>& label, Points& centres) {
  std::vector<double> sx(centres.size()), sy(centres.size());
  std::fill(centres.weight.begin(), centres.weight.end(), 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto c = static_cast<std::size_t>(label[i]);
    centres.weight[c] += p.weight[i];
    sx[c] += p.weight[i] * p.x[i];
    sy[c] += p.weight[i] * p.y[i];
  }
  for (std::size_t c = 0; c < centres.size(); ++c) {
    if (!(centres.weight[c] > 0.0)) continue;
    centres.x[c] = sx[c] / centres.weight[c];
    centres.y[c] = sy[c] / centres.weight[c];
  }
}

/// Returns a closed polygon around clusters on a line, or around one or two clusters.
Points ellipse(const Axis& axis, double low, double high) {
  constexpr int kVertices = 64;
  constexpr double kHalfWidth = 3.0;  // [mm]
  const double half = std::max(0.5 * (high - low), kHalfWidth), middle = 0.5 * (low + high);
  Points p;
  for (int i = 0; i < kVertices; ++i) {
    const double angle = 2.0 * kPi * i / kVertices;
    const double s = middle + half * std::cos(angle), t = kHalfWidth * std::sin(angle);
    p.x.push_back(axis.mean_x + s * axis.x - t * axis.y);
    p.y.push_back(axis.mean_y + s * axis.y + t * axis.x);
  }
  return p;
}

/// Runs Lloyd's iteration from k random points until no point changes its cluster. @return the
/// clusters that kept points.
Points lloyd(const Points& points, int k, int max_iterations, Random& random, int& iterations) {
  // k different points drawn at random
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  shuffle(order, random);
  const std::size_t count = std::min(static_cast<std::size_t>(k), points.size());
  Points centres;
  for (std::size_t c = 0; c < count; ++c) {
    const auto i = static_cast<std::size_t>(order[c]);
    centres.x.push_back(points.x[i]);
    centres.y.push_back(points.y[i]);
  }
  centres.weight.assign(count, 0.0);

  std::vector<int> label(points.size(), -1);
  for (iterations = 0; iterations < max_iterations && assign(points, centres, label);
       ++iterations) {
    update(points, label, centres);
  }
  Points kept;
  for (std::size_t c = 0; c < count; ++c) {
    if (!(centres.weight[c] > 0.0)) continue;
    kept.x.push_back(centres.x[c]);
    kept.y.push_back(centres.y[c]);
    kept.weight.push_back(centres.weight[c]);
  }
  return kept;
}

double tour_length(const Points& points, const Tour& tour) {
  double length = 0.0;
  for (std::size_t i = 0; i < tour.size(); ++i) {
    length += distance(points, tour[i], tour[(i + 1) % tour.size()]);
  }
  return length;
}

/// Improves the tour by 2-opt, from a random order of its points.
void two_opt(const Points& points, Tour& tour, Random& random) {
  shuffle(tour, random);
  const std::size_t n = tour.size();
  for (bool improved = n > 3; improved;) {
    improved = false;
    for (std::size_t i = 0; i + 2 < n; ++i) {
      for (std::size_t j = i + 2; j < n; ++j) {
        const std::size_t after = (j + 1) % n;
        if (after == i) continue;
        const double before_swap =
            distance(points, tour[i], tour[i + 1]) + distance(points, tour[j], tour[after]);
        const double after_swap =
            distance(points, tour[i], tour[j]) + distance(points, tour[i + 1], tour[after]);
        if (after_swap >= before_swap - 1e-9) continue;
        std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(i + 1),
                     tour.begin() + static_cast<std::ptrdiff_t>(j + 1));
        improved = true;
      }
    }
  }
}

/// Splits at the midpoint of the bounds along the principal direction until each tour is at most
/// `max_length`. Heaviest first.
std::vector<Tour> split(const Points& points, const Tour& whole, double max_length,
                        Random& random) {
  std::vector<Tour> open{whole}, leaves;
  while (!open.empty()) {
    const Tour tour = open.back();
    open.pop_back();
    Tour low, high;
    if (tour_length(points, tour) > max_length) {
      const Axis axis(points, tour);
      double first = HUGE_VAL, last = -HUGE_VAL;
      for (const int c : tour) {
        first = std::min(first, axis.along(points, c));
        last = std::max(last, axis.along(points, c));
      }
      for (const int c : tour)
        (axis.along(points, c) <= 0.5 * (first + last) ? low : high).push_back(c);
    }
    if (low.empty() || high.empty()) {
      leaves.push_back(tour);
      continue;
    }
    for (Tour* part : {&low, &high}) {
      two_opt(points, *part, random);
      open.push_back(*part);
    }
  }
  // tours of equal mass are ordered by their first cluster
  std::sort(leaves.begin(), leaves.end(), [&](const Tour& a, const Tour& b) {
    return std::pair(-mass(points, a), a.front()) < std::pair(-mass(points, b), b.front());
  });
  return leaves;
}

/// Appends n points at equal distances along the closed tour; a circle of 3 mm for one point, an
/// ellipse for points on a line.
void resample(const Points& points, const Tour& tour, int n, std::vector<double>& x,
              std::vector<double>& y) {
  // the polygon: the tour itself, or an ellipse if the tour encloses no area
  const Axis axis(points, tour);
  double low = HUGE_VAL, high = -HUGE_VAL, left = HUGE_VAL, right = -HUGE_VAL;
  Points polygon;
  for (const int c : tour) {
    low = std::min(low, axis.along(points, c));
    high = std::max(high, axis.along(points, c));
    left = std::min(left, axis.across(points, c));
    right = std::max(right, axis.across(points, c));
    polygon.x.push_back(points.x[static_cast<std::size_t>(c)]);
    polygon.y.push_back(points.y[static_cast<std::size_t>(c)]);
  }
  if (right - left < 6.0) polygon = ellipse(axis, low, high);

  Tour order(polygon.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const double length = tour_length(polygon, order);
  const auto corners = static_cast<int>(polygon.size());
  int edge = 0;
  double start = 0.0, edge_length = distance(polygon, 0, 1);
  for (int i = 0; i < n; ++i) {
    const double s = length * i / n;
    while (start + edge_length < s && edge + 1 < corners) {
      start += edge_length;
      ++edge;
      edge_length = distance(polygon, edge, (edge + 1) % corners);
    }
    const double t = edge_length > 0.0 ? std::min((s - start) / edge_length, 1.0) : 0.0;
    const auto a = static_cast<std::size_t>(edge),
               b = static_cast<std::size_t>((edge + 1) % corners);
    x.push_back(polygon.x[a] + t * (polygon.x[b] - polygon.x[a]));
    y.push_back(polygon.y[a] + t * (polygon.y[b] - polygon.y[a]));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::textbook
HWY_AFTER_NAMESPACE();
#endif
