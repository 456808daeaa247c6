#include "prostm/device/detail/link_loss.hpp"

#include <gtest/gtest.h>

namespace prostm {
namespace {

using namespace std::chrono_literals;

TEST(LinkLoss, CountsEachLossOnceWithItsBlocks) {
  LinkLoss loss;
  DeviceStats stats{.missed_blocks = 3};
  const LinkLoss::Time begin{};
  loss.add(begin, 0.01, stats);
  EXPECT_EQ(stats.missed_blocks, 3) << "the link is up";
  loss.lose(begin, stats);
  loss.lose(begin + 100ms, stats);  // a failed attempt to reconnect
  DeviceStats meanwhile = stats;
  loss.add(begin + 500ms, 0.01, meanwhile);
  EXPECT_EQ(meanwhile.lost_links, 1);
  EXPECT_EQ(meanwhile.lost_blocks, 50);
  loss.found(begin + 2800ms, 0.01, stats);
  loss.found(begin + 2900ms, 0.01, stats);
  EXPECT_EQ(stats.lost_links, 1);
  EXPECT_EQ(stats.lost_blocks, 280);
  EXPECT_EQ(stats.missed_blocks, 283);
  loss.lose(begin + 4s, stats);
  loss.found(begin + 4100ms, 0.01, stats);
  EXPECT_EQ(stats.lost_links, 2);
  EXPECT_EQ(stats.lost_blocks, 290);
}

}  // namespace
}  // namespace prostm
