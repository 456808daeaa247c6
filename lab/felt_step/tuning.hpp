#pragma once
/// The numbers of the felt step, each halved and doubled: what is felt of the plans, and their
/// cost.

#include <string>
#include <vector>

#include "prostm/plan/detail/fit/felt/felt_step.hpp"
#include "report.hpp"

namespace prostm::bench {

struct TuningVariant {
  std::string name;
  planning::FeltTuning tuning;
};

/// The tuning that is used, and those with one number changed. @param points whether numbers count
/// that matter only where points move.
std::vector<TuningVariant> tuning_variants(bool points);

/// Plans generated fields, one after the other and each twice, the second time displaced by 1 mm,
/// so that a plan continues another one; appends the lack (W3) and the time of a plan.
/// @param fields number of fields. @param points whether what is felt moves points, too.
void compare_tunings(int fields, bool points, std::vector<Row>& rows);

}  // namespace prostm::bench
