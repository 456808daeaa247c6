#pragma once
/// From the fluid's pressure on the hands to target fields (the paper's section IV-A,
/// docs/design.md section C).

#include <array>
#include <boost/container/static_vector.hpp>
#include <span>
#include <utility>
#include <vector>

#include "contact/skin_owner.hpp"
#include "contact/skin_rays.hpp"
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
  // how much an error counts on each part of the hand, where all three are not the same
  double touch_palm = 1.0;    ///< on the palm and the ball of the thumb
  double touch_finger = 1.0;  ///< on the phalanges but the last
  double touch_tip = 1.0;     ///< on the last phalanges

  void visit(SettingsVisitor& v);
};

struct ContactStats {
  int skin_cells = 0;      ///< raster cells with skin, over all patches
  double skin_area = 0.0;  ///< of these, each counted as it has faded [m²]
  int steep_cells = 0;     ///< cells whose skin is too steep for the array, and no part of a target
  int joints_outside =
      0;  ///< joints that lie outside the fluid's box: no pressure is known on the skin there
};

/// Builds one target patch per hand.
///
/// The skin that is visible from the array is found by marching each column of the grid from the
/// array's side to the first crossing of the hand's signed distance. A plane is fitted to these
/// points by least squares without regard to pressure, steep skin counting little (C1), with its
/// axes and origin fixed so that they neither flip nor wander (C2). Each raster cell then marches
/// along the plane's normal to the skin nearest to the array (C3), keeps its height, and reads the
/// fluid's pressure `offset_cells` outside it, from fluid cells alone, clamped at 0 (C4). It fades
/// to nothing where the skin is too steep for the array to press on, and skin beyond that has no
/// target (C6); nor has skin outside the box. All of it is continuous in the hand's pose and
/// remembers nothing of earlier ones, but for the smoothing. Where the settings touch_* differ the
/// patches have weights (C5).
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
  /// The same with any pressure of the air, as Fluid::pressure() and Fluid::fluid_cells() give it.
  /// Both are referred to until the next call. @pre cell_count() values each.
  ContactStats extract(std::span<const float> pressure, std::span<const std::uint8_t> fluid_cells,
                       const HandRaster& raster, const HandFrame& hands, double dt,
                       TargetFrame& out) noexcept;

 private:
  struct SeenSkin {
    Vec3 p_D;
    double weight = 0.0;  // in (C1)
  };
  struct Cells {
    int skin = 0, steep = 0;
    double area = 0.0;
  };
  void take_pressure(std::span<const float> pressure, std::span<const std::uint8_t> fluid_cells,
                     double dt);
  void find_visible();
  std::pair<Vec3, Vec3> fit_plane(std::span<const SeenSkin> visible, const Hand& hand) const;
  bool place_patch(std::span<const SeenSkin> visible, const Hand& hand, TargetField& patch) const;
  void find_skin(int hand, TargetField& patch);
  Cells press(const HandShape& shape, TargetField& patch);
  double pressure_at(const Vec3& p_D) const;
  double touch_at(const HandShape& shape, const Vec3& p_D) const;

  ContactSettings settings_;
  bool has_weights_;  // whether patches get weights
  GridShape grid_;
  int max_side_;
  boost::container::static_vector<HandShape, 2> shapes_;
  SkinRays rays_;
  SkinOwner owner_;
  std::array<std::vector<SeenSkin>, 2> visible_;  // skin of each hand seen from the array
  std::vector<double> fade_;                      // of (C6), by cell of a patch
  std::vector<std::uint32_t> queue_;              // of fill_heights
  std::span<const float> pressure_;      // one value a cell, the fluid's or smoothed over time
  std::span<const std::uint8_t> fluid_;  // cells whose pressure is known
  std::vector<float> smoothed_;          // empty without smoothing, as is was_fluid_
  std::vector<std::uint8_t> was_fluid_;  // when the fluid was last looked at
};

}  // namespace prostm
