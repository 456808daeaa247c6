#include "prostm/core/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

constexpr auto kLongerThanASpin = std::chrono::milliseconds(2);

TEST(WorkerPool, RejectsLessThanOneThread) {
  for (int threads : {0, -3}) {
    try {
      WorkerPool pool(threads);
      FAIL() << threads << " threads were accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(std::to_string(threads)), std::string::npos);
    }
  }
  EXPECT_EQ(WorkerPool(1).threads(), 1);
  EXPECT_EQ(WorkerPool(4).threads(), 4);
}

TEST(WorkerPool, RunsEachIndexOnce) {
  Random random(2);
  for (int threads : {1, 2, 3, 8}) {
    WorkerPool pool(threads);
    for (int region = 0; region < 300; ++region) {
      const int n = random.below(200);
      std::vector<int> runs(static_cast<std::size_t>(n), 0);
      pool.run(n, [&](int i) { ++runs[static_cast<std::size_t>(i)]; });
      ASSERT_EQ(runs, std::vector<int>(static_cast<std::size_t>(n), 1));
    }
  }
}

TEST(WorkerPool, RunsNothingForZeroIndices) {
  WorkerPool pool(2);
  int runs = 0;
  pool.run(0, [&](int) { ++runs; });
  pool.run(-1, [&](int) { ++runs; });
  EXPECT_EQ(runs, 0);
}

TEST(WorkerPool, AcceptsTheLargestRegion) {
  const int n = (1 << 20) - 1;
  std::vector<unsigned char> runs(static_cast<std::size_t>(n), 0);
  WorkerPool pool(3);
  pool.run(n, [&](int i) { ++runs[static_cast<std::size_t>(i)]; });
  std::size_t wrong = 0;
  for (unsigned char count : runs) wrong += count != 1;
  EXPECT_EQ(wrong, 0u);
}

// Regions alternate between two functions, each of which writes the region's number into its own
// cells, without atomics. If a worker that wakes late ran an index or the function of another
// region, a cell would hold another number (and the thread sanitizer would see two writers). A lost
// wake-up or index would hang. There are more threads than cores, so that workers are preempted
// inside a region.
TEST(WorkerPool, LateWorkersNeverTouchAnotherRegion) {
  WorkerPool pool(4);
  std::uint64_t region = 1, wrong = 0;
  std::vector<std::uint64_t> even(3, 0), odd(3, 0);
  const auto write_even = [&](int i) { even[static_cast<std::size_t>(i)] = region; };
  const auto write_odd = [&](int i) { odd[static_cast<std::size_t>(i)] = region; };
  for (const std::uint64_t regions = test::reduced(100000); region <= regions; ++region) {
    if (region % 2 == 0) {
      pool.run(3, write_even);
    } else {
      pool.run(3, write_odd);
    }
    for (std::uint64_t cell : region % 2 == 0 ? even : odd) wrong += cell != region;
  }
  EXPECT_EQ(wrong, 0u);
}

// After a pause the workers are asleep when a region arrives. An index that waits for another
// thread to take the next one hangs unless a sleeping worker is woken.
TEST(WorkerPool, WakesSleepingWorkers) {
  WorkerPool pool(2);
  for (int round = 0; round < 20; ++round) {
    std::this_thread::sleep_for(kLongerThanASpin);
    std::atomic<int> inside{0};
    pool.run(2, [&](int) {
      inside.fetch_add(1);
      while (inside.load() < 2) std::this_thread::yield();
    });
    EXPECT_EQ(inside.load(), 2);
  }
}

TEST(WorkerPool, TheResultDoesNotDependOnTheNumberOfThreads) {
  const auto compute = [](int threads) {
    WorkerPool pool(threads);
    std::vector<double> sums(100, 0.0);
    for (int region = 0; region < 50; ++region) {
      pool.run(100, [&](int i) {
        double& sum = sums[static_cast<std::size_t>(i)];
        sum += std::sin(0.1 * i + region) / 3.0;
      });
    }
    return sums;
  };
  const std::vector<double> one = compute(1);
  for (int threads : {2, 3, 5}) EXPECT_EQ(compute(threads), one);
}

TEST(WorkerPool, StopsWhileSpinningOrAsleep) {
  for (int round = 0; round < 20; ++round) {
    WorkerPool unused(3);
  }
  for (int round = 0; round < 20; ++round) {
    WorkerPool spinning(3);
    spinning.run(8, [](int) {});
  }
  for (int round = 0; round < 5; ++round) {
    WorkerPool asleep(3);
    asleep.run(8, [](int) {});
    std::this_thread::sleep_for(kLongerThanASpin);
  }
}

// Counted on the calling thread and, from its first index on, on each worker.
TEST(WorkerPool, DoesNotAllocate) {
  WorkerPool pool(3);
  std::atomic<std::size_t> by_workers{0};
  const test::HeapGuard guard;
  for (int region = 0; region < 2000; ++region) {
    if (region % 500 == 0) std::this_thread::sleep_for(kLongerThanASpin);
    pool.run(16, [&](int) {
      thread_local const test::HeapGuard of_this_thread;
      by_workers.fetch_add(of_this_thread.allocations());
    });
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(by_workers.load(), 0u);
}

TEST(WorkerPool, TwoPoolsWorkAtOnce) {
  const auto regions = static_cast<int>(test::reduced(20000));
  const auto use = [&](std::uint64_t& sum) {
    WorkerPool pool(2);
    std::vector<std::uint64_t> cells(8, 0);
    for (int region = 0; region < regions; ++region) {
      pool.run(8,
               [&](int i) { cells[static_cast<std::size_t>(i)] += static_cast<std::uint64_t>(i); });
    }
    for (std::uint64_t cell : cells) sum += cell;
  };
  std::uint64_t first = 0, second = 0;
  std::thread other([&] { use(second); });
  use(first);
  other.join();
  EXPECT_EQ(first, 28u * static_cast<std::uint64_t>(regions));
  EXPECT_EQ(second, first);
}

}  // namespace
}  // namespace prostm
