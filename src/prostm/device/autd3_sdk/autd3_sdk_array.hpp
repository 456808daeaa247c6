#pragma once
/// AUTD3 arrays with the firmware of the AUTD3 SDK 0.10, over UDP.

#include <memory>
#include <string>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

struct Autd3SdkSetup {
  std::string address;  ///< %INTERFACE or [IPv6], with :PORT if it is not 44336
  /// Poses X_DU of the units' own frames, in the order of the chain; empty: all units that are
  /// found, side by side along x in this order, centred at D's origin.
  std::vector<Pose> units = {};
  Medium medium = {};
  int foci = 4;  ///< focal points of a sample
  /// Each of up to four focal points has its own intensity; false: up to eight focal points share
  /// the largest intensity.
  bool own_intensities = true;
  int failsafe_ms = 80;  ///< 60..100; units without a message for this long mute themselves
};

/// Load that a stream of blocks puts on the link.
struct Autd3SdkBudget {
  int slots = 8;
  int divider = 4;  ///< periods of 40 kHz per sample
  int block_samples = 100;
  int block_frames = 7;     ///< frames per block and unit, including those that switch to it
  double block_time = 0.0;  ///< [s]
  double load = 0.0;        ///< share of the link
};
/// Returns the budget of these samples in blocks of about this time [s].
/// @param frames_per_ms frames that each unit takes while all units are written to.
Autd3SdkBudget autd3_sdk_budget(int slots, int divider, double block_time, double frames_per_ms);
/// Returns the budget with the highest sampling rate, up to 10 kHz, that leaves half of the link
/// free, with blocks of 10 ms if possible, else of 20 ms.
/// @throws std::invalid_argument if the link is too slow for 2 kHz.
Autd3SdkBudget best_autd3_sdk_budget(int slots, double frames_per_ms);

/// Streams to AUTD3 units. A unit plays one of two banks of samples; each block of the stream is
/// written to the other bank, which starts at the end of the current block. A late block plays one
/// block period later, and the last sample is held until then; no sample is skipped. Units without
/// a message for `failsafe_ms` mute themselves. If units are lost, the device searches for them
/// until they are back; the stream pauses, and resumes from silence.
class Autd3SdkArray final : public Device {
 public:
  /// Finds the units and prepares them, silent. Takes about a second.
  /// @throws std::invalid_argument with a sentence if that fails or the focal points do not fit.
  explicit Autd3SdkArray(const Autd3SdkSetup& setup);
  ~Autd3SdkArray() override;

  /// Returns the info of an array with this setup, on a link that is fast enough for 10 kHz.
  static DeviceInfo info_of(const Autd3SdkSetup& setup);
  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// While a segment plays, a new one replaces it at its end; while a stream plays, segments are
  /// refused.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;
  bool is_hot() const override;

  const Autd3SdkBudget& budget() const;
  /// Number of units, versions of their firmware, and the measured frames per ms.
  std::string description() const override;
  /// Number of times that the units' failsafe muted them. Any thread.
  std::int64_t muted() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
