#include "prostm/device/autd3/autd3_budget.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace prostm {
namespace {

TEST(Autd3Budget, HasTheNumbersOfTheProtocol) {
  struct Row {
    int slots, divider;
    std::array<int, 3> frames;  // for blocks of 10, 20 and 40 ms
  };
  constexpr std::array kRows = {Row{8, 5, {9, 18, 36}}, Row{8, 6, {8, 15, 30}},
                                Row{4, 2, {11, 22, 43}}, Row{4, 3, {8, 15, 29}}};
  for (const Row& row : kRows) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double block_time = std::array{10e-3, 20e-3, 40e-3}[i];
      const Autd3Budget budget = autd3_budget(row.slots, row.divider, block_time, 1.0);
      EXPECT_NEAR(budget.block_frames, row.frames[i], row.divider == 3 && i == 2 ? 1 : 0)
          << row.slots << " slots, divider " << row.divider << ", " << block_time;
    }
  }
  const Autd3Budget budget = autd3_budget(8, 5, 40e-3, 1.0);
  EXPECT_NEAR(budget.load, 37.0 / 40.0, 1e-12);
  EXPECT_NEAR(autd3_budget(8, 6, 20e-3, 1.0).step(), 1.05e-3, 1e-9);
}

TEST(Autd3Budget, IsTheFastestThatCanBeWrittenInTime) {
  for (const double frames_per_ms : {0.5, 0.7, 1.0, 2.0, 5.0}) {
    for (const int slots : {1, 2, 4, 8}) {
      const Autd3Budget best = best_autd3_budget(slots, frames_per_ms);
      EXPECT_LE(best.urgency, 0.9);
      EXPECT_LT(best.load, 0.9);
      if (best.divider > 4) {
        EXPECT_GT(autd3_budget(slots, best.divider - 1, 20e-3, frames_per_ms).urgency, 0.9);
      }
    }
  }
  EXPECT_THROW(best_autd3_budget(8, 0.1), std::invalid_argument);
}

TEST(Autd3Budget, TableCoversSlotsDividersBlocksAndLinks) {
  EXPECT_EQ(autd3_budgets().size(), 4U * 8U * 3U * 3U);
}

}  // namespace
}  // namespace prostm
