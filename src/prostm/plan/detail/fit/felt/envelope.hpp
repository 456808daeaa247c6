#pragma once
/// The field of Eq. (1) in the cells of a felt loss, and its rendering error.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/felt/render_lack.hpp"

namespace prostm::planning {

/// Closed paths in the layout of a felt step's variables: `samples` points each, one path after the
/// other [mm].
struct StepPoints {
  int samples = 0;
  std::span<const float> x, y;

  std::size_t next(std::size_t i) const {
    const auto n = static_cast<std::size_t>(samples);
    return i % n + 1 < n ? i + 1 : i + 1 - n;
  }
};

/// Rendering error of the field of Eq. (1). Only construction allocates.
class EnvelopeLack {
 public:
  explicit EnvelopeLack(std::size_t most_cells);

  /// Sets the points. @param sigma σ of a focus [mm].
  void set_points(const std::vector<FeltCells::Cell>& cells, const StepPoints& points, float sigma);
  /// Returns 1 − S_8.5 of (P10). @param rendering compares with the target in the cells.
  float evaluate(RenderLack<float>& rendering, std::span<const float> pressure);
  /// Returns the spill: the share of the field where the target is below a tenth of its maximum.
  /// @param cells those of set_points().
  float spill(const std::vector<FeltCells::Cell>& cells, std::span<const float> pressure) const;
  /// Adds `weight` times the gradient of the last evaluate() with respect to the pressures.
  void add_gradient(float weight, std::span<float> gradient) const;
  /// Adds `weight` times the gradient of the last evaluate() with respect to the points [1/mm].
  void add_slide(float weight, const StepPoints& points, std::span<const float> pressure,
                 std::span<float> gradient_x, std::span<float> gradient_y) const;

 private:
  /// The point of the paths that is closest to a cell: the cell's field is a·p_first + b·p_second.
  struct Nearest {
    std::uint32_t first = 0, second = 0;
    float a = 0.0F, b = 0.0F;
    float along = 0.0F;          // position on the segment, 0 to 1
    float dx = 0.0F, dy = 0.0F;  // vector from the closest point to the cell [mm]
  };
  void find_nearest(const StepPoints& points);

  std::vector<Nearest> nearest_;
  // for each cell: its position [mm], the closest segment, and the squared distance to it
  std::vector<float> x_, y_, least_;
  std::vector<std::int32_t> segment_;
  float sigma_ = 1.0F;  // [mm]
  Eigen::VectorXf field_, pull_;
};

}  // namespace prostm::planning
