#pragma once
/// AUTD3 arrays of software version 38, over its remote protocol.

#include <memory>
#include <string>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

struct Autd3Setup {
  std::string host;
  int port = 8080;
  std::vector<Pose> units;  ///< X_DU of the units' own frames; empty: one, its middle in D's origin
  Medium medium;
  int foci = 4;  ///< focal points of a sample
  /// An intensity for each of up to four focal points; false: up to eight, which share the largest.
  bool own_intensities = true;
};

/// What a link carries: samples of so many periods of 40 kHz, in blocks.
struct Autd3Budget {
  int slots = 8;
  int divider = 6;  ///< periods of 40 kHz per sample
  int block_samples = 133;
  int block_frames = 15;    ///< frames of a block
  double block_time = 0.0;  ///< [s]
  double load = 0.0;        ///< share of the link, with the frame that keeps a block audible
};
/// Returns the budget of these samples in blocks of about this time [s].
Autd3Budget autd3_budget(int slots, int divider, double block_time, double frames_per_ms);
/// Returns the budget with the highest sampling rate that leaves a quarter of the link free, in
/// blocks of 10 ms if these allow it, else of 20 ms.
/// @throws std::invalid_argument if the link is too slow for 2 kHz.
Autd3Budget best_autd3_budget(int slots, double frames_per_ms);

/// Streams to AUTD3 units. The firmware plays two segments in turn; each block of the stream is
/// written to the one that does not play, and then a modulation that makes it audible until its
/// end. So output falls silent by itself within two blocks if nothing more comes. A connection that
/// is lost is opened again; the stream goes on silently meanwhile.
class Autd3Array final : public Device {
 public:
  /// Connects, and measures the link.
  /// @throws std::invalid_argument with a sentence if that fails or the focal points do not fit.
  explicit Autd3Array(const Autd3Setup& setup);
  ~Autd3Array() override;

  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// Refused: it streams.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;

  const Autd3Budget& budget() const;
  /// Versions of the units' firmware, and the frames per ms that were measured.
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
