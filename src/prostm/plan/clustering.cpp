#include "prostm/plan/clustering.hpp"

#include <algorithm>

#include "prostm/core/random.hpp"

namespace prostm::planning {

WeightedKMeans::WeightedKMeans(std::size_t max_points) {
  for (std::vector<double>* v : {&x_, &y_, &weight_, &distance2_}) v->reserve(max_points);
  label_.reserve(max_points);
}

void WeightedKMeans::clear() {
  x_.clear();
  y_.clear();
  weight_.clear();
}

void WeightedKMeans::add(const Vec2& point, double weight) {
  x_.push_back(point.x());
  y_.push_back(point.y());
  weight_.push_back(weight);
}

int WeightedKMeans::run(int k, int max_iterations, std::uint64_t seed, Clusters& clusters) {
  k_ = static_cast<int>(std::min(static_cast<std::size_t>(k), size()));
  seed_centres(seed);
  return iterate(max_iterations, clusters);
}

int WeightedKMeans::run_from(std::span<const Vec2> seeds, int max_iterations, Clusters& clusters) {
  k_ = static_cast<int>(seeds.size());
  distance2_.assign(size(), 0.0);
  label_.assign(size(), 0);
  for (std::size_t c = 0; c < seeds.size(); ++c) place_seed(c, seeds[c].x(), seeds[c].y());
  return iterate(max_iterations, clusters);
}

/// Runs Lloyd's iteration from the labels of the seeds.
int WeightedKMeans::iterate(int max_iterations, Clusters& clusters) {
  const auto k = static_cast<std::size_t>(k_);
  for (std::size_t c = 0; c < k; ++c) {
    for (std::size_t m = 0; m < k; ++m) neighbour_[c][m] = static_cast<std::uint8_t>(m);
  }
  int iterations = 0;
  do {
    move_centres();
    sort_neighbours();
    ++iterations;
  } while (assign() && iterations < max_iterations);
  move_centres();

  // drop centres that have lost all their points
  clusters.centre.clear();
  clusters.mass.clear();
  for (std::size_t c = 0; c < k; ++c) {
    if (!(mass_[c] > 0.0)) continue;
    clusters.centre.push_back(Vec2(cx_[c], cy_[c]));
    clusters.mass.push_back(mass_[c]);
  }
  return iterations;
}

/// k-means++ [Arthur and Vassilvitskii 2007]: each further seed is a point drawn with probability
/// proportional to w·d², d its distance to the nearest seed so far. Afterwards the labels and
/// distances refer to the nearest seed.
void WeightedKMeans::seed_centres(std::uint64_t seed) {
  const std::size_t n = size();
  Random random(seed);
  distance2_.assign(n, 1.0);
  label_.assign(n, 0);
  for (std::size_t c = 0; c < static_cast<std::size_t>(k_); ++c) {
    // draw a point; rounding may carry the search past the last point of positive probability
    double total = 0.0;
    for (std::size_t i = 0; i < n; ++i) total += weight_[i] * distance2_[i];
    double remaining = random.uniform() * total;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double share = weight_[i] * distance2_[i];
      if (share > 0.0) chosen = i;
      remaining -= share;
      if (remaining < 0.0) break;
    }
    place_seed(c, x_[chosen], y_[chosen]);
  }
}

/// Makes (x, y) seed c, and assigns it the points that are nearer to it than to all earlier seeds.
void WeightedKMeans::place_seed(std::size_t c, double x, double y) {
  cx_[c] = x;
  cy_[c] = y;
  for (std::size_t i = 0; i < size(); ++i) {
    const double dx = x_[i] - x, dy = y_[i] - y, d2 = dx * dx + dy * dy;
    if (c > 0 && d2 >= distance2_[i]) continue;
    distance2_[i] = d2;
    label_[i] = static_cast<std::uint8_t>(c);
  }
}

void WeightedKMeans::move_centres() {
  std::array<double, kMaxClusters> sx{}, sy{};
  mass_.fill(0.0);
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t c = label_[i];
    mass_[c] += weight_[i];
    sx[c] += weight_[i] * x_[i];
    sy[c] += weight_[i] * y_[i];
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(k_); ++c) {
    if (!(mass_[c] > 0.0)) continue;
    cx_[c] = sx[c] / mass_[c];
    cy_[c] = sy[c] / mass_[c];
  }
}

/// Insertion sort from the order of the previous iteration, which is nearly right.
void WeightedKMeans::sort_neighbours() {
  const auto k = static_cast<std::size_t>(k_);
  for (std::size_t c = 0; c < k; ++c) {
    auto& order = neighbour_[c];
    auto& key = separation2_[c];
    for (std::size_t m = 0; m < k; ++m) {
      const std::uint8_t other = order[m];
      const double dx = cx_[other] - cx_[c], dy = cy_[other] - cy_[c];
      const double d2 = other == c ? -1.0 : dx * dx + dy * dy;
      std::size_t place = m;
      for (; place > 0 && key[place - 1] > d2; --place) {
        key[place] = key[place - 1];
        order[place] = order[place - 1];
      }
      key[place] = d2;
      order[place] = other;
    }
  }
}

/// Assigns every point to its nearest centre. By the triangle inequality, a centre cannot be nearer
/// to a point if its distance to the point's present centre is more than twice the point's distance
/// to that, so only a few neighbours are tested. @return whether any point changed its centre.
bool WeightedKMeans::assign() {
  bool changed = false;
  const auto k = static_cast<std::size_t>(k_);
  for (std::size_t i = 0; i < size(); ++i) {
    const std::uint8_t present = label_[i];
    const auto distance2 = [&](std::uint8_t c) {
      const double dx = x_[i] - cx_[c], dy = y_[i] - cy_[c];
      return dx * dx + dy * dy;
    };
    double best = distance2(present);
    const double bound = 4.0 * best;
    std::uint8_t nearest = present;
    for (std::size_t m = 1; m < k && separation2_[present][m] < bound; ++m) {
      const std::uint8_t c = neighbour_[present][m];
      const double d2 = distance2(c);
      if (d2 >= best) continue;
      best = d2;
      nearest = c;
    }
    label_[i] = nearest;
    changed = changed || nearest != present;
  }
  return changed;
}

}  // namespace prostm::planning
