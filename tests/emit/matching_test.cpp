#include "prostm/emit/detail/matching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

double total(const MatchCosts& cost, const std::vector<int>& match) {
  double sum = 0.0;
  for (std::size_t f = 0; f < match.size(); ++f) {
    sum += cost[f][match[f] == kNoPath ? kMaxPaths : static_cast<std::size_t>(match[f])];
  }
  return sum;
}

TEST(MatchPaths, FindsTheOptimumOverAllPermutations) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const int foci = 1 + random.below(6), paths = random.below(foci + 1);
    MatchCosts cost{};
    for (auto& row : cost) {
      for (double& c : row) c = random.uniform();
    }
    const auto found = match_paths(cost, foci, paths);

    // every path once
    const std::vector<int> match(found.begin(), found.begin() + foci);
    std::multiset<int> used(match.begin(), match.end());
    for (int p = 0; p < paths; ++p) EXPECT_EQ(used.count(p), 1u);
    EXPECT_EQ(used.count(kNoPath), static_cast<std::size_t>(foci - paths));

    // no permutation is cheaper
    std::vector<int> other(static_cast<std::size_t>(foci), kNoPath);
    std::iota(other.end() - paths, other.end(), 0);
    double least = 1e9;
    do {
      least = std::min(least, total(cost, other));
    } while (std::next_permutation(other.begin(), other.end()));
    EXPECT_NEAR(total(cost, match), least, 1e-12);
  }
}

TEST(MatchPaths, MatchesEightByEight) {
  Random random(2);
  MatchCosts cost{};
  for (auto& row : cost) row.fill(1.0);
  // a hidden permutation is free
  const std::array<int, kMaxPaths> hidden{3, 0, 7, 5, 1, 6, 2, 4};
  for (std::size_t f = 0; f < kMaxPaths; ++f) cost[f][static_cast<std::size_t>(hidden[f])] = 0.0;
  EXPECT_EQ(match_paths(cost, kMaxPaths, kMaxPaths), hidden);
}

}  // namespace
}  // namespace prostm
