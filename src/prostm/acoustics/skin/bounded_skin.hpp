#pragma once
/// Skin of finite extent, whose edges reflect waves: the second model of the skin. (S14) to (S17)
/// of docs/design/skin.md.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/detail/bounded_waves.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"

namespace prostm {

/// The response of skin that ends at the outline of a mask. Near a load it moves like the
/// half-space, and its surface waves are those of the half-space, but the edges are free and
/// reflect them. With distant edges it converges to the half-space.
class BoundedSkin : public SkinMotion {
 public:
  /// @param skin rows·cols; not 0 where there is skin. @param finest upper bound of the grid
  /// spacing of the waves [m].
  /// @throws std::invalid_argument as SkinResponse does, and for a mask that is not of the patch's
  /// size or has no skin, or `finest` not in 0.2 to 5 mm.
  BoundedSkin(const SkinModel& model, const SkinPatch& patch, std::span<const std::uint8_t> skin,
              double finest = 2.5e-3);

  /// As SkinResponse::prepare; factors a matrix for each harmonic.
  void prepare(double period, int samples, double highest = 1000.0);

  /// Computes the response to a loop: (S9) with the near part of the skin, plus (S15). Pressure off
  /// the skin is ignored, and the displacement is 0 there. Allocates. @throws as
  /// SkinResponse::respond.
  void respond(const PressureLoop& loop);

 private:
  SkinModel model_;
  std::vector<std::uint8_t> skin_;
  int parts_;  // elements along the edge of a cell: even, so that a corner is at each cell's centre
  SkinResponse near_;
  BoundedWaves waves_;
  Eigen::MatrixXd along_rows_,
      along_cols_;                // corners × cells: interpolation of the pressure, (S17)
  std::vector<double> pressure_;  // pressure of a loop, 0 off the skin
};

}  // namespace prostm
