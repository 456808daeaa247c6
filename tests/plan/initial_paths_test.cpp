#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "prostm/core/random.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/detail/tours.hpp"

namespace prostm {
namespace {

using namespace planning;

struct Cloud {
  std::vector<Vec2> x;
  std::vector<double> weight;
};

Cloud random_cloud(Random& random, int count) {
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.x.push_back(Vec2(random.uniform(0, 150), random.uniform(0, 150)));
    cloud.weight.push_back(random.uniform(0.01, 1.0));
  }
  return cloud;
}

std::size_t nearest(const Clusters& clusters, const Vec2& x) {
  std::size_t best = 0;
  for (std::size_t c = 1; c < clusters.centre.size(); ++c) {
    if ((clusters.centre[c] - x).squaredNorm() < (clusters.centre[best] - x).squaredNorm())
      best = c;
  }
  return best;
}

TEST(WeightedKMeans, EndsWhenEveryCentreIsTheMeanOfItsNearestPoints) {
  Random random(31);
  for (int trial = 0; trial < 30; ++trial) {
    const Cloud cloud = random_cloud(random, 60 + random.below(1500));
    WeightedKMeans kmeans(cloud.x.size());
    for (std::size_t i = 0; i < cloud.x.size(); ++i) kmeans.add(cloud.x[i], cloud.weight[i]);
    Clusters clusters;
    const int iterations = kmeans.run(50, 10'000, 1, clusters);
    ASSERT_LT(iterations, 10'000);
    ASSERT_EQ(clusters.centre.size(), 50u);

    // a fixed point of Lloyd's iteration by its plain definition, without shortcuts
    std::array<Vec2, kMaxClusters> sum;
    sum.fill(Vec2::Zero());
    std::array<double, kMaxClusters> mass{};
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const std::size_t c = nearest(clusters, cloud.x[i]);
      sum[c] += cloud.weight[i] * cloud.x[i];
      mass[c] += cloud.weight[i];
    }
    for (std::size_t c = 0; c < 50; ++c) {
      ASSERT_NEAR(mass[c], clusters.mass[c], 1e-9);
      ASSERT_LT((sum[c] / mass[c] - clusters.centre[c]).norm(), 1e-9);
    }
  }
}

TEST(WeightedKMeans, FewPointsFormTheirOwnClusters) {
  Random random(32);
  for (const int count : {1, 2, 7, 50}) {
    const Cloud cloud = random_cloud(random, count);
    WeightedKMeans kmeans(50);
    for (std::size_t i = 0; i < cloud.x.size(); ++i) kmeans.add(cloud.x[i], cloud.weight[i]);
    Clusters clusters;
    kmeans.run(50, 100, 7, clusters);
    ASSERT_EQ(clusters.centre.size(), cloud.x.size());
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const std::size_t c = nearest(clusters, cloud.x[i]);
      EXPECT_LT((clusters.centre[c] - cloud.x[i]).norm(), 1e-12);
      EXPECT_DOUBLE_EQ(clusters.mass[c], cloud.weight[i]);
    }
  }
}

Clusters clusters_of(const Cloud& cloud) {
  Clusters clusters;
  clusters.centre.assign(cloud.x.begin(), cloud.x.end());
  clusters.mass.assign(cloud.weight.begin(), cloud.weight.end());
  return clusters;
}

Tour in_order(std::size_t count) {
  Tour tour(count);
  std::iota(tour.begin(), tour.end(), std::uint8_t{0});
  return tour;
}

TEST(Tours, NoReversalShortensATwoOptTour) {
  Random random(33);
  for (int trial = 0; trial < 20; ++trial) {
    const Cloud cloud = random_cloud(random, 4 + random.below(47));
    DistanceTable distance;
    distance.set(cloud.x);
    Tour tour = in_order(cloud.x.size());
    const double length = shortest_tour(distance, {tour.data(), tour.size()}, 1);
    EXPECT_DOUBLE_EQ(length, tour_length(distance, {tour.data(), tour.size()}));
    for (std::size_t i = 0; i < tour.size(); ++i) {
      for (std::size_t j = i + 1; j <= tour.size(); ++j) {
        Tour other = tour;
        std::reverse(other.begin() + static_cast<std::ptrdiff_t>(i),
                     other.begin() + static_cast<std::ptrdiff_t>(j));
        ASSERT_GE(tour_length(distance, {other.data(), other.size()}), length - 1e-8);
      }
    }
    std::sort(tour.begin(), tour.end());
    EXPECT_EQ(tour, in_order(cloud.x.size()));
  }
}

TEST(Tours, SmallToursAreNearlyAlwaysTheShortest) {
  // compared with every order of seven points
  Random random(34);
  int optimal = 0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Cloud cloud = random_cloud(random, 7);
    DistanceTable distance;
    distance.set(cloud.x);
    Tour tour = in_order(7), order = in_order(7);
    const double length = shortest_tour(distance, {tour.data(), tour.size()}, 1);
    double shortest = HUGE_VAL;
    do {
      shortest = std::min(shortest, tour_length(distance, {order.data(), order.size()}));
    } while (std::next_permutation(order.begin() + 1, order.end()));
    EXPECT_GE(length, shortest - 1e-9);
    optimal += length <= shortest + 1e-9 ? 1 : 0;
  }
  EXPECT_GE(optimal, 95);
}

TEST(Tours, SplitsDistributeTheClustersAndKeepTheLength) {
  Random random(35);
  for (int trial = 0; trial < 50; ++trial) {
    const Cloud cloud = random_cloud(random, 1 + random.below(50));
    const Clusters clusters = clusters_of(cloud);
    DistanceTable distance;
    distance.set(cloud.x);
    const auto leaves = split_tours(clusters, distance, in_order(cloud.x.size()), 140.0, 1);
    Tour all;
    double previous = HUGE_VAL;
    for (const Leaf& leaf : leaves) {
      EXPECT_LE(tour_length(distance, {leaf.tour.data(), leaf.tour.size()}), 140.0);
      EXPECT_LE(leaf.mass, previous);
      previous = leaf.mass;
      for (const std::uint8_t c : leaf.tour) all.push_back(c);
    }
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, in_order(cloud.x.size()));
  }
}

TEST(Tours, SplitsAreAtTheMidpointAlongTheWeightedDirection) {
  // heavy points spread along x, a light one far away along y: the cut is orthogonal to x
  Clusters clusters;
  for (const double x : {0.0, 40.0, 100.0}) {
    clusters.centre.push_back(Vec2(x, 0.0));
    clusters.mass.push_back(1.0);
  }
  clusters.centre.push_back(Vec2(45.0, 120.0));
  clusters.mass.push_back(1e-3);
  DistanceTable distance;
  distance.set({clusters.centre.data(), clusters.centre.size()});
  const auto leaves = split_tours(clusters, distance, in_order(4), 290.0, 1);
  ASSERT_EQ(leaves.size(), 2u);
  EXPECT_NEAR(leaves[0].mass, 2.001, 1e-12);
  ASSERT_EQ(leaves[1].tour.size(), 1u);
  EXPECT_EQ(leaves[1].tour[0], 2);
}

TEST(Tours, SamplesAreAtEqualArcLengths) {
  Clusters clusters;
  for (const Vec2& x : {Vec2(0, 0), Vec2(30, 0), Vec2(30, 10), Vec2(0, 10)}) {
    clusters.centre.push_back(x);
    clusters.mass.push_back(1.0);
  }
  std::array<Vec2, 8> x;
  const Tour tour = in_order(4);
  resample_tour(clusters, {tour.data(), tour.size()}, x);
  for (int i = 0; i < 8; ++i) {
    const double s = 10.0 * i;
    const Vec2 expected = s <= 30   ? Vec2(s, 0)
                          : s <= 40 ? Vec2(30, s - 30)
                          : s <= 70 ? Vec2(70 - s, 10)
                                    : Vec2(0, 80 - s);
    EXPECT_LT((x[static_cast<std::size_t>(i)] - expected).norm(), 1e-12);
  }
}

TEST(Tours, ThinSetsOfClustersStartAsEnclosingLoops) {
  for (const int count : {1, 2, 3, 6}) {
    Clusters clusters;
    for (int i = 0; i < count; ++i) {
      clusters.centre.push_back(Vec2(7.0 * i, 7.0 * i));
      clusters.mass.push_back(1.0);
    }
    std::array<Vec2, 20> x;
    const Tour tour = in_order(static_cast<std::size_t>(count));
    resample_tour(clusters, {tour.data(), tour.size()}, x);
    double area = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      area += 0.5 * cross(x[i], x[(i + 1) % x.size()]);
      EXPECT_GT((x[i] - x[(i + 1) % x.size()]).norm(), 0.1);
    }
    const double half_length = std::max(0.5 * (count - 1) * 7.0 * std::sqrt(2.0), 3.0);
    EXPECT_NEAR(area, kPi * 3.0 * half_length, 0.1 * area);
  }
}

}  // namespace
}  // namespace prostm
