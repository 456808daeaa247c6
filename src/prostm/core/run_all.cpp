#include "prostm/core/run_all.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

namespace prostm {

void run_all(WorkerPool& pool, int n, const std::function<void(int)>& f) {
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(std::max(n, 0)));
  std::atomic<bool> failed{false};
  pool.run(n, [&](int i) {
    if (failed) return;
    try {
      f(i);
    } catch (...) {
      failures[static_cast<std::size_t>(i)] = std::current_exception();
      failed = true;
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace prostm
