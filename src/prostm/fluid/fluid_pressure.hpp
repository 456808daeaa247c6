#pragma once
/// The fluid's pressure on skin (C4).

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "prostm/contact/pressure_source.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// The part of the pressure that is felt: all of it, that of the smoke that blows, or that of the
/// hands' own movement, which the same hands would feel in air that nothing blows.
enum class PressurePart : std::uint8_t { All, Smoke, Movement };
template <>
inline constexpr std::array<std::string_view, 3> kNames<PressurePart> = {"all", "smoke",
                                                                         "movement"};

struct FluidPressureSettings {
  PressurePart part = PressurePart::All;  ///< read by the world, which computes parts
  bool parts = false;  ///< targets hold both parts too, also where all of the pressure is felt
  /// the pressure is read this far outside the skin, towards the array [m]; a length, so that
  /// finer cells do not move it
  double offset = 0.005625;
  /// time constant of exponential smoothing of the fluid's pressure on the skin [s]; 0 = no
  /// smoothing
  double time_constant = 0.0;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const FluidPressureSettings&) const = default;
};

/// Reads the pressure of the air `offset` outside the skin, from fluid cells alone, and smooths it
/// over time if the settings ask for it.
class FluidPressure final : public PressureSource {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  FluidPressure(const FluidPressureSettings& settings, const GridShape& grid);

  /// Moves the grid to another corner [m], by whole cells. Cells that are new have no history.
  void move_to(const Vec3& p_DF);

  /// Takes the present state of the air from Fluid::pressure() and Fluid::fluid_cells(); both are
  /// referred to until the next call. @pre cell_count() values each. @param dt time since the last
  /// call, for the smoothing [s].
  void take(std::span<const float> pressure, std::span<const std::uint8_t> fluid_cells, double dt);

  /// Gives 0 where no fluid is near. @pre take() was called.
  void sample(std::span<const Vec3> p_D, const Vec3& outside,
              std::span<double> out) const noexcept override;

 private:
  double at(const Vec3& p_D) const;

  FluidPressureSettings settings_;
  GridShape grid_;
  std::span<const float> pressure_;      // one value a cell, the fluid's or smoothed over time
  std::span<const std::uint8_t> fluid_;  // cells whose pressure is known
  // empty without smoothing, all four
  std::vector<float> smoothed_, next_smoothed_;  // the latter is scratch of move_to()
  std::vector<std::uint8_t> was_fluid_,
      next_was_fluid_;  // cells that were fluid at the last take()
};

}  // namespace prostm
