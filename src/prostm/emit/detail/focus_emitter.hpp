#pragma once
/// Foci as focal points over time: amplitude modulation.

#include <memory>

#include "prostm/emit/emitter.hpp"

namespace prostm {

/// Turns plans of foci into samples: all focal points stand still and are modulated by one
/// envelope (B4), whose period is a whole number of samples, each with its own phase (B7). A new
/// plan takes over at the envelope's next zero, where its foci are matched to the focal points by
/// least total distance (B5) and get their intensities, sqrt(pressure / full scale) at the peak,
/// all scaled by one factor if the power limit requires it; they keep both until the next plan.
/// With phases, each focal point switches at a zero of its own; one whose phase changes is silent
/// from that zero to the zero of its new phase. Focal points move between two silent samples, so a
/// zero at which a plan takes over lasts one sample longer for all of them, which keeps the phases.
///
/// The guarantees are those of PathEmitter; some are trivial here. After lose(), or when plans stop
/// coming, the output is silent from the next zero on: at most one period, 40 ms.
/// docs/design/am.md.
class FocusEmitter final : public Emitter {
 public:
  /// @param sample_rate of the device [Hz], at least 3150.
  /// @throws as validate() does, and for settings.am_frequency out of bounds.
  FocusEmitter(const EmitSettings& settings, double sample_rate);
  ~FocusEmitter() override;

  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

  /// Number of samples in a period of the modulation.
  int period() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
