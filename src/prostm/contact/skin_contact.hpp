#pragma once
/// Converts the pressure on the hands to target fields (the paper's section IV-A,
/// docs/design/contact.md).

#include <array>
#include <boost/container/static_vector.hpp>
#include <span>
#include <utility>
#include <vector>

#include "prostm/contact/detail/skin_owner.hpp"
#include "prostm/contact/detail/skin_rays.hpp"
#include "prostm/contact/pressure_source.hpp"
#include "prostm/core/quantity.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

struct ContactSettings {
  // weights of errors on the parts of the hand; without effect if all three are the same
  double touch_palm = 1.0;    ///< weight on the palm and the ball of the thumb
  double touch_finger = 1.0;  ///< weight on all phalanges but the last
  double touch_tip = 1.0;     ///< weight on the last phalanges

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const ContactSettings&) const = default;
};

struct ContactStats {
  std::int64_t skin_cells = 0;   ///< raster cells with skin, over all patches
  double skin_area = 0.0;        ///< area of these, weighted by the fade (C6) [m²]
  std::int64_t steep_cells = 0;  ///< cells without target, whose skin is too steep for the array
  std::int64_t joints = 0;       ///< joints of the hands
  /// joints outside the grid, where no pressure is known
  std::int64_t joints_outside = 0;
};
/// Share of the skin's cells that are too steep; 0 without skin.
double steep_share(const ContactStats& stats);
template <>
std::span<const Quantity<ContactStats>> quantities<ContactStats>();

/// Builds one target patch per hand.
///
/// The skin that is visible from the array is found by marching each column of the grid from the
/// array's side to the first crossing of the hand's signed distance. A plane is fitted to these
/// points by least squares, independently of the pressure and with low weights for steep skin (C1);
/// its axes and origin are chosen such that they neither flip nor drift (C2). From each raster cell
/// a ray marches along the plane's normal to the skin nearest to the array (C3); the cell gets its
/// height, and the source's pressure there, clamped at 0 (C4). The pressure fades to 0 as the skin
/// becomes too steep for the array to press on (C6); steeper skin, and skin outside the box, has no
/// target. The result is continuous in the hand's pose and independent of earlier poses. If the
/// settings touch_* differ, the patches have weights (C5).
class SkinContact {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  SkinContact(const ContactSettings& settings, const GridShape& grid);

  /// Maximum number of cells of a patch of extract().
  std::size_t max_cells() const {
    return static_cast<std::size_t>(max_side_) * static_cast<std::size_t>(max_side_);
  }

  /// Computes the patches of a hand frame. @param raster the hands of `hands` on the constructor's
  /// grid, whose corner may have moved by whole cells.  @param hands in frame D; `out` gets their
  /// time.  @param parts parts of the source's pressure. Patches contain those named smoke and
  /// movement, if both are given.
  ContactStats extract(const PressureSource& source, const HandRaster& raster,
                       const HandFrame& hands, TargetFrame& out,
                       std::span<const NamedPressure> parts = {}) noexcept;

 private:
  struct SeenSkin {
    Vec3 p_D;
    double weight = 0.0;  // weight in (C1)
  };
  struct Pressed {
    std::size_t cell;
    double fade;  // fade of (C6)
  };
  struct Cells {
    int skin = 0, steep = 0;
    double area = 0.0;
  };
  void find_visible();
  std::pair<Vec3, Vec3> fit_plane(std::span<const SeenSkin> visible, const Hand& hand) const;
  bool place_patch(std::span<const SeenSkin> visible, const Hand& hand, TargetField& patch) const;
  void find_skin(int hand, TargetField& patch);
  Cells press(const PressureSource& source, const HandShape& shape, TargetField& patch);
  void press_part(const PressureSource& part, const TargetField& patch, std::vector<double>& out);
  double fade_at(const Vec3& p_D, const TargetField& patch) const;
  double touch_at(const HandShape& shape, const Vec3& p_D) const;

  ContactSettings settings_;
  bool has_weights_;  // whether patches get weights
  GridShape grid_;
  Vec3 anchor_;  // the corner of the constructor's grid; does not move with the raster's
  int max_side_;
  boost::container::static_vector<HandShape, 2> shapes_;
  SkinRays rays_;
  SkinOwner owner_;
  std::array<std::vector<SeenSkin>, 2> visible_;  // skin of each hand seen from the array
  std::vector<std::uint32_t> queue_;              // scratch of fill_heights
  // cells that the array can press on, and their positions
  std::vector<Pressed> pressed_;
  std::vector<Vec3> points_;
  std::vector<double> pressures_;
};

}  // namespace prostm
