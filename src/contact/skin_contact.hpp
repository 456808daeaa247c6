#pragma once
/// From the fluid's pressure on the hands to target fields (the paper's section IV-A).

#include "core/settings.hpp"
#include "fluid/fluid.hpp"
#include "hand/hand_raster.hpp"
#include "target/target_field.hpp"

namespace prostm {

struct ContactSettings {
  double offset_cells = 1.0;     ///< the pressure is read this many cells outside the skin, towards the array
  double time_constant = 0.0;    ///< of an exponential smoothing of the target between frames [s]; 0 = none

  void visit(SettingsVisitor& v);
};

struct ContactStats {
  int skin_cells = 0;            ///< raster cells with skin, over all patches
  int outside = 0;               ///< skin columns that leave the fluid's box: no pressure is known there
};

/// Builds one target patch per hand: for each column of the grid, marching from the array's side, the first skin cell; the
/// pressure there, clamped at 0; a plane fitted to those points by least squares without regard to pressure; the points
/// projected and gathered on a raster of the fluid's cell size, the nearest to the array winning; their heights kept.
class SkinContact {
 public:
  SkinContact(const ContactSettings& settings, const GridShape& grid);

  /// @param frame the hands of the raster, frame D. Writes frame.time and one patch per hand that is inside the box.
  ContactStats extract(const Fluid& fluid, const HandRaster& raster, const HandFrame& frame, TargetFrame& out) noexcept;

 private:
  ContactSettings settings_;
  GridShape grid_;
  struct SkinPoint { Vec3 p_D; double pressure; int hand; };
  std::vector<SkinPoint> points_;
};

}  // namespace prostm
