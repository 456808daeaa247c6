#pragma once
/// The smoke of a fluid as one array.

#include <vector>

#include "prostm/fluid/fluid.hpp"

namespace prostm::test {

/// One value per cell: x fastest, then y, then z.
inline std::vector<float> smoke_of(const Fluid& fluid) {
  std::vector<float> out;
  for (int k = 0; k < fluid.grid().nz; ++k) {
    for (int j = 0; j < fluid.grid().ny; ++j) {
      const auto row = fluid.smoke_row(j, k);
      out.insert(out.end(), row.begin(), row.end());
    }
  }
  return out;
}

}  // namespace prostm::test
