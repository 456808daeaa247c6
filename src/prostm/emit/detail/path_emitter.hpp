#pragma once
/// Paths as focal points over time: sampling, transitions, fade-out.

#include <memory>

#include "prostm/emit/emitter.hpp"

namespace prostm {

/// Turns plans of paths into samples.
///
/// Guarantees, for any sequence of plans: while its intensity is above 1 % a focal point moves at
/// most max_speed (8 m/s is 0.2 mm between samples at 40 kHz), its intensity changes by at most
/// 1/40 per sample, intensities lie in [0, 1], Σ intensity² is within the limit, and every number
/// is finite.
///
/// A new plan's paths are matched to the focal points, (E5). Each focal point switches at the end
/// of its lap (at the next block with switch_at = "now", or if a lap takes over 1 s): by moving,
/// if the new path is near, (E3), else by fading down, jumping while silent, and fading up. Focal
/// points that all start from silence begin at their paths' first points; one that starts while
/// others are running begins where it keeps away from them, (E6). A focal point without a path
/// fades down and rests where it is.
///
/// Plans in step share the clock of one loop, (E10): a new plan takes over for all focal points at
/// the end of the loop (at the next block with switch_at = "now"), and each joins its path at the
/// place that corresponds to the clock, (E11). docs/design/emission.md.
class PathEmitter final : public Emitter {
 public:
  /// @param sample_rate of the device [Hz].  @param max_speed above 0, at most kMaxFocusSpeed
  /// [m/s]. @throws as validate() does.
  PathEmitter(const EmitSettings& settings, double sample_rate, double max_speed = kMaxFocusSpeed);
  ~PathEmitter() override;

  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
