#pragma once
/// Numbers in participants' files.

#include <cmath>

namespace prostm::study {

/// A number with so many decimals, so that files stay small.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(scale * value) / scale;
}

}  // namespace prostm::study
