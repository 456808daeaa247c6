#include "prostm/core/worker_pool.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace prostm {
namespace {

constexpr int kSpins = 4000;  // tens of microseconds
constexpr int kEndShift = 20, kRegionShift = 40;
constexpr std::uint64_t kIndexMask = 0xfffff, kRegionMask = 0xffffff;

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

WorkerPool::WorkerPool(int threads) : parts_(static_cast<std::size_t>(std::max(threads, 1))) {
  if (threads < 1) {
    throw std::invalid_argument("threads = " + std::to_string(threads) + " must be at least 1");
  }
  for (std::size_t self = 1; self < parts_.size(); ++self) {
    workers_.emplace_back([this, self](const std::stop_token& stop) { work(stop, self); });
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
  // publish the region; pending_ first, since workers start as soon as they see the tickets
  const std::uint64_t region = (region_.load(std::memory_order_relaxed) + 1) & kRegionMask;
  call_.store(call, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  pending_.store(n, std::memory_order_relaxed);
  const auto size = static_cast<std::uint64_t>(n), count = std::uint64_t{parts_.size()};
  for (std::uint64_t part = 0; part < count; ++part) {
    const std::uint64_t begin = size * part / count, end = size * (part + 1) / count;
    parts_[part].ticket.store(region << kRegionShift | end << kEndShift | begin,
                              std::memory_order_release);
  }
  {
    const std::lock_guard lock(mutex_);
    region_.store(region, std::memory_order_release);
  }
  wake_.notify_all();

  drain(region, 0);

  // wait for the indices taken by workers; they are running, so this is short unless one was
  // preempted
  for (int spins = 0; pending_.load(std::memory_order_acquire) != 0;) {
    if (spins < kSpins) {
      relax();
      ++spins;
    } else {
      std::this_thread::yield();
    }
  }
}

void WorkerPool::drain(std::uint64_t region, std::size_t self) {
  int done = 0;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    std::atomic<std::uint64_t>& ticket = parts_[(self + part) % parts_.size()].ticket;
    std::uint64_t seen = ticket.load(std::memory_order_acquire);
    while (seen >> kRegionShift == region &&
           (seen & kIndexMask) < (seen >> kEndShift & kIndexMask)) {
      if (!ticket.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel,
                                        std::memory_order_acquire))
        continue;
      const Call call = call_.load(std::memory_order_relaxed);
      call(context_.load(std::memory_order_relaxed), static_cast<int>(seen & kIndexMask));
      ++done;
      seen = ticket.load(std::memory_order_acquire);
    }
  }
  // only once, because all threads write here
  if (done > 0) pending_.fetch_sub(done, std::memory_order_acq_rel);
}

void WorkerPool::work(const std::stop_token& stop, std::size_t self) {
  std::uint64_t seen = 0;
  while (!stop.stop_requested()) {
    for (int spins = 0; spins < kSpins && region_.load(std::memory_order_acquire) == seen; ++spins)
      relax();
    if (region_.load(std::memory_order_acquire) == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [&] { return region_.load(std::memory_order_acquire) != seen; });
    }
    seen = region_.load(std::memory_order_acquire);
    drain(seen, self);
  }
}

}  // namespace prostm
