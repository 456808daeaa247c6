#pragma once
/// The percept of the pressure of an array on the skin.

#include <span>
#include <vector>

#include "prostm/acoustics/skin/bounded_skin.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/score/physical.hpp"

namespace prostm {

/// Duration of the longest loop whose percept is computed [s].
inline constexpr double kLongestFelt = 0.25;

/// Returns whether the percept of a loop can be computed: the loop takes at most kLongestFelt, at
/// up to 100 kHz, and the raster has at most 128 cells along an edge, of 0.1 to 20 mm. Beyond these
/// limits there are too many harmonics or cells.
bool is_felt(const TargetField& raster, const LoopSamples& loop);

/// Returns the number of equal parts of a loop whose mean pressures act on the skin model. @pre
/// is_felt(raster, loop)
int felt_parts(const LoopSamples& loop);

/// Perceived strength of a loop, rows·cols; 0 where there is no skin.
struct FeltField {
  std::vector<double> percept;  ///< √e, (S7) [m]
  double largest = 0.0;         ///< largest value of `percept` [m]
  double intensity = 0.0;       ///< √E, (S8) [m]
};

/// Returns the percept of a computed response. @pre the patch is that of the raster
FeltField felt_field(const TargetField& raster, const SkinMotion& motion);

/// Computes the pressure of the loop that an array plays on the whole raster, felt_parts(loop) ×
/// rows·cols; 0 off the skin [Pa]. @throws as LoopBasis and loop_pressure() do. @pre
/// is_felt(raster, loop)
std::vector<double> raster_pressure(const PackedArray& packed, const Medium& medium,
                                    const TargetField& raster, const LoopSamples& loop,
                                    const LoopDriveResult& drives, WorkerPool& pool);

/// Skin on the raster of a target, with the nominal parameters of (S1) to (S5).
class FeelingSkin {
 public:
  /// @throws std::invalid_argument as SkinResponse does.
  explicit FeelingSkin(const TargetField& raster);

  /// Computes the percept of a given pressure.
  /// @param pressure parts × rows·cols values [Pa], for equal parts of a loop of `period` [s].
  /// @throws std::invalid_argument as SkinResponse does. @pre the raster is that of the
  /// constructor.
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

/// One harmonic of a percept. "Strongest" is the cell of skin where √e is largest.
struct FeltHarmonic {
  double frequency = 0.0;               ///< [Hz]
  double share_at_strongest = 0.0;      ///< share of e at the strongest cell, (S7)
  double share_of_intensity = 0.0;      ///< share of E, (S8)
  double displacement_strongest = 0.0;  ///< rms over time at the strongest cell [m]
  double velocity_strongest = 0.0;      ///< rms over time at the strongest cell [m/s]
  double displacement_skin = 0.0;       ///< rms over time and all skin [m]
  double velocity_skin = 0.0;           ///< rms over time and all skin [m/s]
};
/// Returns all harmonics of a computed response, the lowest first; shares add up to 1, or are all 0
/// for a skin at rest. @pre the patch is that of the raster, which has skin
std::vector<FeltHarmonic> felt_spectrum(const TargetField& raster, const SkinMotion& motion);

/// Skin that ends at the outline of the raster's skin, and whose edges reflect waves: a second
/// model, for evaluation, (S14) to (S17).
class FeelingBoundedSkin {
 public:
  /// @throws std::invalid_argument as BoundedSkin does.
  explicit FeelingBoundedSkin(const TargetField& raster, const SkinSettings& settings = {});

  /// Same as FeelingSkin::feel() for a given pressure. For a hand, the first loop of a period takes
  /// about a second, further ones some tens of ms.
  FeltField feel(const TargetField& raster, double period, int parts,
                 std::span<const double> pressure);

 private:
  BoundedSkin skin_;
  double period_ = 0.0;
  int parts_ = 0;
};

/// False hot spots: strong local maxima of the percept away from the target.
struct Ghosts {
  int count = 0;         ///< local maxima above half of the map's largest value
  double largest = 0.0;  ///< largest local maximum there, over the map's largest value
};
/// Finds the local maxima of a percept on skin farther than 10 mm from every cell whose target is
/// at least 0.1 of the maximum.
Ghosts ghosts_of(const TargetField& target, const std::vector<double>& percept);

}  // namespace prostm
