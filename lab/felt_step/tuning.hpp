#pragma once
/// The numbers of the felt step, each halved and doubled: quality of the percept, and cost.

#include <string>
#include <vector>

#include "prostm/plan/detail/fit/felt/felt_step.hpp"
#include "report.hpp"

namespace prostm::bench {

struct TuningVariant {
  std::string name;
  planning::FeltTuning tuning;
};

/// Returns the tuning in use, and those with one number changed. @param points whether to include
/// numbers that matter only if points move.
std::vector<TuningVariant> tuning_variants(bool points);

/// Plans generated fields, one after the other and each twice, the second time displaced by 1 mm,
/// so that a plan continues another one; appends the lack (W3) and the time of a plan.
/// @param fields number of fields. @param points whether the felt step also moves points.
void compare_tunings(int fields, bool points, std::vector<Row>& rows);

}  // namespace prostm::bench
