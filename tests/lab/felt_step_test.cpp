#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>

#include "felt_step/tuning.hpp"

namespace prostm::bench {
namespace {

using planning::FeltTuning;
/// The numbers of a tuning, which consists of floats and ints only.
using Numbers = std::array<std::uint32_t, sizeof(FeltTuning) / sizeof(std::uint32_t)>;

int differences(const FeltTuning& a, const FeltTuning& b) {
  const auto x = std::bit_cast<Numbers>(a), y = std::bit_cast<Numbers>(b);
  int count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) count += x[i] != y[i] ? 1 : 0;
  return count;
}

TEST(FeltTunings, ChangeOneNumberEachAndEveryNumberTwice) {
  std::set<std::string> names;
  for (const bool points : {false, true}) {
    const std::vector<TuningVariant> variants = tuning_variants(points);
    EXPECT_EQ(differences(variants.front().tuning, FeltTuning()), 0);
    for (std::size_t v = 1; v < variants.size(); ++v) {
      EXPECT_EQ(differences(variants[v].tuning, FeltTuning()), 1) << variants[v].name;
      EXPECT_TRUE(names.insert(variants[v].name).second) << variants[v].name;
    }
  }
  EXPECT_EQ(names.size(), 2 * Numbers().size());
}

TEST(FeltTunings, AreComparedByTheLackOfTheirPlans) {
  std::vector<Row> rows;
  compare_tunings(1, false, rows);
  EXPECT_EQ(rows.size(), 2 * tuning_variants(false).size());
  for (const Row& row : rows) {
    EXPECT_GT(row.ours.mean, 0.0) << row.name;
    EXPECT_LT(row.ours.mean, 1.3) << row.name;  // relative to a flat percept
  }
}

}  // namespace
}  // namespace prostm::bench
