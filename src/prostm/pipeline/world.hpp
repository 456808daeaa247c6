#pragma once
/// Sources of the pressure on hands: smoke, or a world of your own (docs/guides/cpp.md).

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "prostm/contact/pressure_source.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/stimulus/stimulus.hpp"
#include "prostm/target/target_field.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// A quantity declared by a world. Each step has a value; a run's summary has the mean.
struct WorldQuantity {
  const char* name;       ///< name of the mean in files
  const char* unit = "";  ///< unit in files; empty if dimensionless
  const char* help = "";
  /// Clause of a printed summary, with {} for the mean; empty: its name, value and unit.
  const char* words = "";
  double words_scale = 1.0;  ///< factor from the value in files to that in `words`
};
inline constexpr std::size_t kMaxWorldQuantities = 8;

/// The result of a step.
struct WorldStats {
  bool reset = false;  ///< a number was not finite, and the world restarted at rest
  /// Values in the order of World::quantities(); the rest is unused.
  std::array<double, kMaxWorldQuantities> values = {};
};

/// A row of cells of the grid along x, for pictures.
struct SeenRow {
  std::span<const float> density;      ///< from 0 (clear) to 1 (opaque); empty: nothing is visible
  std::span<const std::uint8_t> open;  ///< 0 in hands and other solids
};

/// A source of pressure. A step has three parts, so that the hands are needed late: prepare, meet,
/// settle, in this order and on one thread. After construction no method throws or allocates.
class World {
 public:
  virtual ~World() = default;
  /// The grid on which hands are rasterised and their skin is found. Only its corner may change, by
  /// whole cells in prepare().
  virtual const GridShape& grid() const = 0;
  /// Target pressure that maps to full output [Pa].
  virtual double full_scale_pressure() const = 0;

  /// Does the part of a step of dt [s] that needs no hands.
  virtual void prepare(double dt) noexcept { static_cast<void>(dt); }
  /// Receives the hands, rasterised on grid().
  virtual void meet(const HandRaster& raster) noexcept = 0;
  /// Returns the current pressure on the skin. @param dt since the last call [s].
  virtual const PressureSource& pressure(double dt) noexcept = 0;
  /// Parts of that pressure, if the world computes them; valid until the next step. @pre pressure()
  /// was called.
  virtual std::span<const NamedPressure> parts() const noexcept { return {}; }
  /// Receives the resulting target before settle(). @param target made from pressure().  @param dt
  /// since the last call [s].
  virtual void observe_target(const HandFrame& hands, const TargetFrame& target,
                              double dt) noexcept {
    static_cast<void>(hands), static_cast<void>(target), static_cast<void>(dt);
  }
  /// Does the rest of the step, off the critical path.
  virtual WorldStats settle() noexcept { return {}; }

  /// The quantities in WorldStats::values, at most kMaxWorldQuantities. The list must outlive the
  /// world and all summaries.
  virtual std::span<const WorldQuantity> quantities() const noexcept { return {}; }
  /// Returns the current appearance of a row of cells (·, j, k).
  virtual SeenRow seen_row(int j, int k) const noexcept {
    static_cast<void>(j), static_cast<void>(k);
    return {};
  }
  /// Copies the compatible state of another world. @pre between steps.
  virtual void continue_from(const World& other) { static_cast<void>(other); }
  /// The stimulus that the scene should produce, and its place; nothing for scenes without a
  /// stimulus.
  virtual std::optional<PlacedStimulus> stimulus() const { return {}; }
};

}  // namespace prostm
