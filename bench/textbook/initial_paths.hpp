#pragma once
/// Path initialisation of the textbook planner: plain Lloyd, plain 2-opt, midpoint splits.

#include <vector>

#include "core/random.hpp"

namespace prostm::textbook {

/// Weighted points of the plane [mm].
struct Points {
  std::vector<double> x, y, weight;
  std::size_t size() const { return x.size(); }
};

using Tour = std::vector<int>;

/// Lloyd's iteration from k random points until no point changes its cluster. @return the clusters
/// that kept points.
Points lloyd(const Points& points, int k, int max_iterations, Random& random, int& iterations);

double tour_length(const Points& points, const Tour& tour);

/// 2-opt from a random order of the tour's points.
void two_opt(const Points& points, Tour& tour, Random& random);

/// Splits at the midpoint of the bounds along the principal direction until each tour is at most
/// `max_length`. Heaviest first.
std::vector<Tour> split(const Points& points, const Tour& whole, double max_length, Random& random);

/// n points at equal distances along the closed tour; a circle of 3 mm for one point, an ellipse
/// for points on a line.
void resample(const Points& points, const Tour& tour, int n, std::vector<double>& x,
              std::vector<double>& y);

}  // namespace prostm::textbook
