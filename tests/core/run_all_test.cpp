#include "prostm/core/run_all.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace prostm {
namespace {

TEST(RunAll, CallsEachIndexOnce) {
  WorkerPool pool(2);
  std::vector<int> calls(50, 0);
  run_all(pool, 50, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
  EXPECT_EQ(calls, std::vector<int>(50, 1));
  run_all(pool, 0, [](int) { FAIL(); });
}

TEST(RunAll, AnExceptionEndsIt) {
  WorkerPool alone(1);
  int calls = 0;
  EXPECT_THROW(run_all(alone, 10,
                       [&](int i) {
                         ++calls;
                         if (i == 3) throw std::out_of_range("three");
                       }),
               std::out_of_range);
  EXPECT_EQ(calls, 4);
}

TEST(RunAll, ThrowsTheExceptionOfTheLowestIndex) {
  WorkerPool pool(2);
  std::atomic<int> waiting = 0;
  try {
    run_all(pool, 2, [&](int i) {
      ++waiting;
      while (waiting < 2) std::this_thread::yield();  // so that both calls begin
      throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "0");
  }
}

}  // namespace
}  // namespace prostm
