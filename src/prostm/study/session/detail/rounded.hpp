#pragma once
/// Numbers in participants' files.

#include <cmath>

namespace prostm::study {

/// Rounds to a number of decimals, to keep files small.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(scale * value) / scale;
}

}  // namespace prostm::study
