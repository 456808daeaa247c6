#include "prostm/core/worker_pool.hpp"

#include <stdexcept>
#include <string>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace prostm {
namespace {

constexpr int kSpins = 4000;  // tens of microseconds
constexpr int kSizeShift = 20, kRegionShift = 40;
constexpr std::uint64_t kIndexMask = 0xfffff, kRegionMask = 0xffffff;

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

WorkerPool::WorkerPool(int threads) {
  if (threads < 1) {
    throw std::invalid_argument("threads = " + std::to_string(threads) + " must be at least 1");
  }
  for (int i = 1; i < threads; ++i) {
    workers_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

WorkerPool::~WorkerPool() {
  for (auto& worker : workers_) worker.request_stop();
  workers_.clear();  // the stop token wakes the sleepers; jthread joins
}

void WorkerPool::run_erased(int n, Call call, void* context) {
  if (n <= 0) return;
  if (workers_.empty() || n == 1) {
    for (int i = 0; i < n; ++i) call(context, i);
    return;
  }
  // publish the region; pending_ first, since the ticket lets workers in
  const std::uint64_t region = (region_.load(std::memory_order_relaxed) + 1) & kRegionMask;
  call_.store(call, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  pending_.store(n, std::memory_order_relaxed);
  ticket_.store(region << kRegionShift | static_cast<std::uint64_t>(n) << kSizeShift,
                std::memory_order_release);
  {
    const std::lock_guard lock(mutex_);
    region_.store(region, std::memory_order_release);
  }
  wake_.notify_all();

  drain(region);

  // wait for what the workers took; they are running, so this is short unless one lost its core
  for (int spins = 0; pending_.load(std::memory_order_acquire) != 0;) {
    if (spins < kSpins) {
      relax();
      ++spins;
    } else {
      std::this_thread::yield();
    }
  }
}

void WorkerPool::drain(std::uint64_t region) {
  for (;;) {
    std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
    do {
      const std::uint64_t index = ticket & kIndexMask, size = ticket >> kSizeShift & kIndexMask;
      if (ticket >> kRegionShift != region || index >= size) return;
    } while (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel,
                                            std::memory_order_acquire));
    const Call call = call_.load(std::memory_order_relaxed);
    call(context_.load(std::memory_order_relaxed), static_cast<int>(ticket & kIndexMask));
    pending_.fetch_sub(1, std::memory_order_acq_rel);
  }
}

void WorkerPool::work(const std::stop_token& stop) {
  std::uint64_t seen = 0;
  while (!stop.stop_requested()) {
    for (int spins = 0; spins < kSpins && region_.load(std::memory_order_acquire) == seen; ++spins)
      relax();
    if (region_.load(std::memory_order_acquire) == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [&] { return region_.load(std::memory_order_acquire) != seen; });
    }
    seen = region_.load(std::memory_order_acquire);
    drain(seen);
  }
}

}  // namespace prostm
