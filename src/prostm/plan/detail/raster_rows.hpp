#pragma once
/// Kernels that pass over all cells of a target.

#include <cstdint>
#include <span>

namespace prostm::planning {

/// Returns the largest value on skin, or 0; −1 if any value, on skin or not, is negative, above
/// `most` or not a number. Raises no floating-point exception for those. @pre most > 0; equal
/// sizes.
double checked_maximum(std::span<const double> values, std::span<const std::uint8_t> skin,
                       double most);

/// Sums over some rows of a raster, column by column; only cells with skin are included.
struct ColumnSums {
  std::span<double> value;
  std::span<double> count;  ///< number of cells
  std::span<double> row;    ///< sum of their row indices
};

/// Computes the sums over rows [begin, end). @param values, skin the whole raster in row-major
/// order, with as many columns as there are sums. @pre values are finite.
void sum_rows(std::span<const double> values, std::span<const std::uint8_t> skin, int begin,
              int end, const ColumnSums& sums);

}  // namespace prostm::planning
