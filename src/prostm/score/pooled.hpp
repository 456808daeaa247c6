#pragma once
/// Multi-threaded scores for large rasters.

#include "prostm/core/worker_pool.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

/// Same as score_plan() of score.hpp, bit for bit, on the threads of a pool.
Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma,
                   const GainLaw& gain, const SegmentPressures* instead, WorkerPool& pool);

/// Same as controls() of score.hpp, bit for bit, on the threads of a pool.
std::vector<Control> controls(const TargetField& target, double sigma, const GainLaw& gain,
                              double length, const Plan* other, std::uint64_t seed,
                              const std::function<void(int done, int all)>& progress,
                              WorkerPool& pool);

}  // namespace prostm
