#pragma once
/// The percept of the pressure that an array puts on the skin.

#include <span>
#include <vector>

#include "prostm/acoustics/skin/bounded_skin.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/score/physical.hpp"

namespace prostm {

/// The longest loop whose percept is computed [s].
inline constexpr double kLongestFelt = 0.25;

/// Whether the percept of a loop is computed: the loop takes at most kLongestFelt, at up to
/// 100 kHz, and the raster has at most 128 cells along an edge, of 0.1 to 20 mm. Beyond these, the
/// skin has too many harmonics or places.
bool is_felt(const TargetField& raster, const LoopSamples& loop);

/// Number of equal parts of a loop whose mean pressures the skin feels. @pre is_felt(raster, loop)
int felt_parts(const LoopSamples& loop);

/// Perceived strength of a loop, rows·cols; 0 where there is no skin.
struct FeltField {
  std::vector<double> percept;  ///< √e, (S7) [m]
  double largest = 0.0;         ///< largest value of `percept` [m]
  double intensity = 0.0;       ///< √E, (S8) [m]
};

/// Returns the percept of a skin that has responded. @pre the patch is that of the raster
FeltField felt_field(const TargetField& raster, const SkinMotion& motion);

/// Skin under the raster of targets, with the nominal parameters of (S1) to (S5).
class FeelingSkin {
 public:
  /// @throws std::invalid_argument as SkinResponse does.
  explicit FeelingSkin(const TargetField& raster);

  /// Computes the percept of a given pressure.
  /// @param pressure on the raster for each of `parts` equal parts of a loop of `period` [s], part
  /// by part [Pa]. @throws std::invalid_argument as SkinResponse does. @pre the raster is that of
  /// the constructor.
  FeltField feel(const TargetField& raster, double period, int parts,
                 std::span<const double> pressure);
  /// Computes the percept of the loop that an array plays. @throws as LoopBasis and
  /// loop_pressure() do. @pre is_felt(raster, loop)
  FeltField feel(const PackedArray& packed, const Medium& medium, const TargetField& raster,
                 const LoopSamples& loop, const LoopDriveResult& drives, WorkerPool& pool);
  /// The skin's motion under the last loop.
  const SkinMotion& motion() const { return response_; }

 private:
  SkinResponse response_;
};

/// One harmonic of a loop as it is felt. "Strongest" is the place of skin where √e is largest.
struct FeltHarmonic {
  double frequency = 0.0;               ///< [Hz]
  double share_at_strongest = 0.0;      ///< of e there, (S7)
  double share_of_intensity = 0.0;      ///< of E, (S8)
  double displacement_strongest = 0.0;  ///< rms, there [m]
  double velocity_strongest = 0.0;      ///< rms, there [m/s]
  double displacement_skin = 0.0;       ///< rms, over all skin too [m]
  double velocity_skin = 0.0;           ///< rms, over all skin too [m/s]
};
/// Returns all harmonics of a skin that has responded, the lowest first; shares add up to 1, or are
/// all 0 for a skin at rest. @pre the patch is that of the raster, which has skin
std::vector<FeltHarmonic> felt_spectrum(const TargetField& raster, const SkinMotion& motion);

/// Skin that ends where that of the raster ends, and whose edges send waves back: a second model,
/// to judge by, (S14) to (S17).
class FeelingBoundedSkin {
 public:
  /// @throws std::invalid_argument as BoundedSkin does.
  explicit FeelingBoundedSkin(const TargetField& raster, const SkinSettings& settings = {});

  /// As FeelingSkin::feel with a given pressure. The first loop of a period takes about a second
  /// for a hand, further ones some tens of ms.
  FeltField feel(const TargetField& raster, double period, int parts,
                 std::span<const double> pressure);

 private:
  BoundedSkin skin_;
  double period_ = 0.0;
  int parts_ = 0;
};

/// Strong places of the percept where the target has nothing to feel.
struct Ghosts {
  int count = 0;         ///< local maxima above half of the map's largest value
  double largest = 0.0;  ///< largest local maximum there, over the map's largest value
};
/// Finds the local maxima of a percept on skin that is farther than 10 mm from every cell with a
/// target of 0.1 max or more.
Ghosts ghosts_of(const TargetField& target, const std::vector<double>& percept);

}  // namespace prostm
