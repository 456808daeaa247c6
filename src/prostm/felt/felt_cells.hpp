#pragma once
/// A target in the cells of a felt loss.

#include <cstddef>
#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// Maximum number of blocks with skin: for choosing pressures, and for moving points.
inline constexpr std::size_t kFeltCells = 512, kFinerFeltCells = 800;

/// The skin of a target, averaged over square blocks of its raster.
class FeltCells {
 public:
  static constexpr double kWidth = 6e-3;        ///< width of a block, unless a cell is wider [m]
  static constexpr std::size_t kBlocks = 4096;  ///< maximum number, with and without skin

  /// @param most maximum number of blocks with skin.
  explicit FeltCells(std::size_t most);

  /// Averages the skin of a target over blocks of at most kWidth, or wider ones if there would be
  /// too many. Allocates nothing. @param maximum the target's largest pressure, > 0.
  void set(const TargetField& target, double maximum);

  struct Cell {
    int row = 0, col = 0;     ///< row and column of the block
    double x = 0.0, y = 0.0;  ///< mean position, from the centre of the target's cell (0, 0) [mm]
    double area = 0.0;        ///< share of the skin, with the target's weights if it has any
    double pressure = 0.0;    ///< mean p* over the maximum
  };
  const std::vector<Cell>& cells() const { return cells_; }
  int rows() const { return rows_; }       ///< rows of blocks
  int cols() const { return cols_; }       ///< columns of blocks
  double pitch() const { return pitch_; }  ///< distance of neighbouring blocks [mm]

 private:
  bool fill(const TargetField& target, double maximum, int width);

  std::size_t most_;
  int rows_ = 0, cols_ = 0;
  double pitch_ = 0.0;
  std::vector<Cell> cells_, blocks_;
};

}  // namespace prostm
