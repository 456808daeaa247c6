#include "prostm/target/rounding.hpp"

namespace prostm {

void clear_rounding(TargetField& field) {
  const double least = -kPressureRounding * max_pressure(field);
  for (double& p : field.pressure) {
    if (p < 0.0 && p >= least) p = 0.0;
  }
}

}  // namespace prostm
