#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "prostm/score/score.hpp"

namespace prostm {
namespace {

TEST(Metrics, AreAllListed) {
  std::set<std::string> names;
  for (const Quantity<Metrics>& metric : quantities<Metrics>()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_NE(std::string(metric.help), "");
    EXPECT_NE(std::string(metric.label), "");
    EXPECT_NE(metric.better, Better::Neither);
    EXPECT_TRUE(std::holds_alternative<double Metrics::*>(metric.value));
  }
  EXPECT_EQ(names.size() * sizeof(double), sizeof(Metrics));
}

TEST(Metrics, MeanAndMedianAreTakenSeparately) {
  std::array<Metrics, 4> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].rmse = static_cast<double>(i * i);         // 0 1 4 9
    all[i].spill = 3.0 - static_cast<double>(i);      // 3 2 1 0
    all[i].felt_skill = i == 1 ? std::nan("") : 0.5;  // unknown in one case
  }
  EXPECT_EQ(mean(all).rmse, 3.5);
  EXPECT_EQ(median(all).rmse, 2.5);
  EXPECT_EQ(median(all).spill, 1.5);
  EXPECT_EQ(median({all.data(), 3}).rmse, 1.0);
  EXPECT_TRUE(std::isnan(median(all).felt_skill));
  EXPECT_TRUE(std::isnan(mean(all).felt_skill));
  EXPECT_EQ(median({all.data() + 2, 2}).felt_skill, 0.5);
}

}  // namespace
}  // namespace prostm
