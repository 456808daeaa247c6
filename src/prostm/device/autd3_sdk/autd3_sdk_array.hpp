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
  /// X_DU of the units' own frames, along their chain; empty: as many as there are, side by side
  /// along x in the order of the chain, their middle in D's origin.
  std::vector<Pose> units = {};
  Medium medium = {};
  int foci = 4;  ///< focal points of a sample
  /// An intensity for each of up to four focal points; false: up to eight, which share the largest.
  bool own_intensities = true;
  int failsafe_ms = 80;  ///< 60..100; the units fall silent when they hear nothing for so long
};

/// Load of the link: samples of so many periods of 40 kHz, in blocks.
struct Autd3SdkBudget {
  int slots = 8;
  int divider = 4;  ///< periods of 40 kHz per sample
  int block_samples = 100;
  int block_frames = 7;     ///< frames of a block and unit, with those that change over to it
  double block_time = 0.0;  ///< [s]
  double load = 0.0;        ///< share of the link
};
/// Returns the budget of these samples in blocks of about this time [s].
/// @param frames_per_ms that each unit takes while all are sent to.
Autd3SdkBudget autd3_sdk_budget(int slots, int divider, double block_time, double frames_per_ms);
/// Returns the budget with the highest sampling rate, up to 10 kHz, that leaves half of the link
/// free, in blocks of 10 ms if these allow it, else of 20 ms.
/// @throws std::invalid_argument if the link is too slow for 2 kHz.
Autd3SdkBudget best_autd3_sdk_budget(int slots, double frames_per_ms);

/// Streams to AUTD3 units. Their logic plays one of two banks; each block of the stream is written
/// to the other one, which takes over at the end of the block that plays. A block that comes too
/// late is played a block's time later, and the last sample is held meanwhile; no sample is
/// skipped. Units that hear nothing for `failsafe_ms` mute themselves. Units that are lost are
/// looked for until they are back; the stream waits, and then goes on from silence.
class Autd3SdkArray final : public Device {
 public:
  /// Finds the units and prepares them, silent. Takes a second or so.
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
  /// While a segment plays, the new one takes over at its end; while a stream plays, segments are
  /// refused.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;
  bool is_hot() const override;

  const Autd3SdkBudget& budget() const;
  /// Number of units, versions of their firmware, and the frames per ms that were measured.
  std::string description() const override;
  /// How often the units' failsafe had muted them. Any thread.
  std::int64_t muted() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
