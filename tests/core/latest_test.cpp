#include "prostm/core/latest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using Block = std::array<std::uint64_t, 64>;  // larger than any atomic write

TEST(Latest, HasNothingNewBeforeTheFirstPublication) {
  Latest<int> latest(7);
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 7);
  latest.draft() = 8;
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 7);
}

TEST(Latest, NewestValueIsReadOnce) {
  Latest<int> latest;
  for (int i = 1; i <= 5; ++i) {
    latest.draft() = i;
    latest.publish();
  }
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 5);
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 5);
}

TEST(Latest, TheWriterDoesNotTouchTheReadersValue) {
  Latest<int> latest;
  latest.draft() = 1;
  latest.publish();
  ASSERT_TRUE(latest.refresh());
  for (int i = 2; i < 10; ++i) {
    latest.draft() = i;
    latest.publish();
    EXPECT_EQ(latest.value(), 1);
  }
}

// The writer fills every word of a block with its number; a torn block would hold two numbers.
TEST(Latest, IsNeitherTornNorReorderedBetweenThreads) {
  const std::uint64_t last = test::reduced(300000);
  Latest<Block> latest;
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= last; ++n) {
      latest.draft().fill(n);
      latest.publish();
    }
  });

  std::uint64_t previous = 0, torn = 0, backwards = 0;
  while (previous < last) {
    if (!latest.refresh()) {
      std::this_thread::yield();
      continue;
    }
    const Block& block = latest.value();
    torn += std::count(block.begin(), block.end(), block[0]) != 64;
    backwards += block[0] <= previous;
    previous = block[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_FALSE(latest.refresh());
}

TEST(Latest, DoesNotAllocate) {
  Latest<Block> latest;
  const test::HeapGuard guard;
  for (std::uint64_t n = 0; n < 100; ++n) {
    latest.draft().fill(n);
    latest.publish();
    latest.refresh();
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace prostm
