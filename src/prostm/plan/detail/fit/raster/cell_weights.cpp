#include "prostm/plan/detail/fit/raster/cell_weights.hpp"

#include "prostm/target/pressure_share.hpp"

namespace prostm::planning {

CellWeights::CellWeights(const TargetField& target, double maximum)
    : target_(&target), largest_(max_weight(target)) {
  double counted = 0.0, all = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] == 0) continue;
    const double p = pressure_share(target.pressure[i], maximum);
    all += p;
    counted += share(i) * p;
  }
  any_pressure_ = counted > kLeastShare * all;
  mean_ = any_pressure_ ? counted / all : 1.0;
}

}  // namespace prostm::planning
