#include "prostm/core/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <deque>
#include <stdexcept>
#include <thread>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

TEST(SpscRing, RejectsCapacityZero) {
  EXPECT_THROW(SpscRing<int>(0), std::invalid_argument);
  EXPECT_EQ(SpscRing<int>(1).capacity(), 1u);
}

TEST(SpscRing, RejectsValuesWhenFullAndKeepsTheOthers) {
  SpscRing<int> ring(2);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_FALSE(ring.push(3));
  EXPECT_EQ(ring.back(), nullptr);
  int value = 0;
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 1);
  EXPECT_TRUE(ring.push(4));
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 2);
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 4);
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(ring.front(), nullptr);
}

// Random pushes and pops compared with std::deque, for several capacities, including 1.
TEST(SpscRing, BehavesAsABoundedQueue) {
  Random random(1);
  for (std::size_t capacity : {1, 2, 3, 7, 64}) {
    SpscRing<int> ring(capacity);
    std::deque<int> model;
    const test::HeapGuard guard;
    std::size_t own = 0;  // allocations by the reference queue
    for (int i = 0; i < 5000; ++i) {
      if (random.below(2) == 0) {
        ASSERT_EQ(ring.push(i), model.size() < capacity);
        const std::size_t before = guard.allocations();
        if (model.size() < capacity) model.push_back(i);
        own += guard.allocations() - before;
      } else {
        int value = -1;
        ASSERT_EQ(ring.pop(value), !model.empty());
        if (!model.empty()) {
          ASSERT_EQ(value, model.front());
          model.pop_front();
        }
      }
    }
    EXPECT_EQ(guard.allocations(), own);
  }
}

// Every value arrives intact, once and in order.
TEST(SpscRing, IsOrderedAndIntactBetweenThreads) {
  using Value = std::array<std::uint64_t, 8>;
  const std::uint64_t last = test::reduced(400000);
  SpscRing<Value> ring(10);
  std::thread writer([&] {
    for (std::uint64_t n = 0; n < last;) {
      Value* slot = ring.back();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      slot->fill(n++);
      ring.commit();
    }
  });

  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < last;) {
    const Value* value = ring.front();
    if (value == nullptr) {
      std::this_thread::yield();
      continue;
    }
    for (std::uint64_t word : *value) wrong += word != expected;
    ring.pop();
    ++expected;
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(ring.front(), nullptr);
}

}  // namespace
}  // namespace prostm
