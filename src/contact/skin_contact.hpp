#pragma once
/// From the fluid's pressure on the hands to target fields (the paper's section IV-A,
/// docs/design.md section C).

#include <boost/container/static_vector.hpp>
#include <vector>

#include "core/settings.hpp"
#include "fluid/fluid.hpp"
#include "hand/hand_raster.hpp"
#include "target/target_field.hpp"

namespace prostm {

struct ContactSettings {
  double offset_cells =
      1.0;  ///< the pressure is read this many cells outside the skin, towards the array
  double time_constant =
      0.0;  ///< of an exponential smoothing of the fluid's pressure on the skin [s]; 0 = none

  void visit(SettingsVisitor& v);
};

struct ContactStats {
  int skin_cells = 0;  ///< raster cells with skin, over all patches
  int joints_outside =
      0;  ///< joints that lie outside the fluid's box: no pressure is known on the skin there
};

/// Builds one target patch per hand.
///
/// The skin that is visible from the array is found by marching each column of the grid from the
/// array's side to the first crossing of the hand's signed distance. A plane is fitted to these
/// points by least squares without regard to pressure (C1), with its axes and origin fixed so that
/// they neither flip nor wander (C2). Each raster cell then marches along the plane's normal to the
/// skin nearest to the array (C3), keeps its height, and reads the fluid's pressure `offset_cells`
/// outside it, from fluid cells alone (C4), clamped at 0. Skin outside the box has no target.
class SkinContact {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  SkinContact(const ContactSettings& settings, const GridShape& grid);

  /// Largest raster that extract() makes, cells.
  std::size_t max_cells() const {
    return static_cast<std::size_t>(max_side_) * static_cast<std::size_t>(max_side_);
  }

  /// @param raster the hands of `hands` on the fluid's grid.  @param hands in frame D, of which
  /// frame.time is written.
  /// @param dt time since the last call, for the smoothing [s].
  ContactStats extract(const Fluid& fluid, const HandRaster& raster, const HandFrame& hands,
                       double dt, TargetFrame& out) noexcept;

 private:
  void find_visible(const HandRaster& raster, int hand);
  bool place_patch(const HandRaster& raster, TargetField& patch) const;
  int gather(const HandRaster& raster, int hand, TargetField& patch) const;
  bool belongs_to(const Vec3& p_D, int hand) const;
  void smooth_pressure(const Fluid& fluid, double dt);
  double pressure_at(const Vec3& p_D) const;

  ContactSettings settings_;
  GridShape grid_;
  int max_side_;
  boost::container::static_vector<HandShape, 2> shapes_;
  std::vector<Vec3> visible_;        // skin of one hand seen from the array, frame D
  std::vector<float> pressure_;      // smoothed over time, one value a cell
  std::vector<std::uint8_t> fluid_;  // cells whose pressure is known
};

}  // namespace prostm
