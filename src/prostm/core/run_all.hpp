#pragma once
/// Long tasks on a WorkerPool.

#include <functional>

#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Calls f(0) … f(n − 1) as WorkerPool::run() does, for functions that may throw. After an
/// exception no further call begins. @throws the exception of the lowest index that has one
void run_all(WorkerPool& pool, int n, const std::function<void(int)>& f);

}  // namespace prostm
