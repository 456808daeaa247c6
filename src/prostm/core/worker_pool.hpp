#pragma once
/// A small thread pool for short parallel regions, with bounded spinning.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace prostm {

/// `run(n, f)` calls f(0) … f(n−1), each once, on the caller and `threads − 1` workers, and returns
/// when all are done. Each thread begins with its own part of the indices, the same one in every
/// region, to reuse the data in its cache; then it helps the others. So the thread of an index is
/// not fixed. If f writes only to places that depend on the index alone, results do not depend on
/// the number of threads. Only one thread may start regions, one at a time; regions do not nest.
///
/// A worker spins for a bounded time after a region (the next one usually follows at once), then
/// sleeps: on a machine with more runnable threads than cores, no thread waits for a spinning one
/// longer than that bound.
class WorkerPool {
 public:
  /// @param threads total number, including the caller; 1 runs everything on the caller. @throws
  /// std::invalid_argument if < 1.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// @pre n < 2^20; f does not throw. Does not allocate.
  template <class F>
  void run(int n, F&& f) {
    using Function = std::remove_reference_t<F>;
    run_erased(
        n, [](void* context, int i) { (*static_cast<Function*>(context))(i); },
        const_cast<void*>(static_cast<const void*>(&f)));
  }

 private:
  using Call = void (*)(void*, int);
  void run_erased(int n, Call call, void* context);
  void work(const std::stop_token& stop, std::size_t self);
  void drain(std::uint64_t region, std::size_t self);

  // Each thread's part of a region is distributed from one word: region number (24 bits), end (20),
  // next index (20). A worker that wakes late compares the whole word, so it can never take an
  // index of another region.
  struct alignas(64) Part {
    std::atomic<std::uint64_t> ticket{0};
  };
  std::vector<Part> parts_;      // the caller's first
  std::atomic<int> pending_{0};  // indices of this region not yet finished
  std::atomic<Call> call_{nullptr};
  std::atomic<void*> context_{nullptr};
  std::atomic<std::uint64_t> region_{0};
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::jthread> workers_;
};

}  // namespace prostm
