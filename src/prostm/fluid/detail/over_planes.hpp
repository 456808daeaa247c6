#pragma once
/// Work on the planes of a grid, shared among threads.

#include <algorithm>

#include "prostm/core/worker_pool.hpp"

namespace prostm::fluid {

/// Runs f(k0, k1) over the planes [0, n), a few at a time.
template <class F>
void over_planes(WorkerPool& pool, int n, F&& f) {
  constexpr int kPlanes = 4;
  pool.run((n + kPlanes - 1) / kPlanes,
           [&](int task) { f(task * kPlanes, std::min(n, (task + 1) * kPlanes)); });
}

}  // namespace prostm::fluid
