#pragma once
/// What can be driven: arrays, real or simulated.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// What a device can do.
struct DeviceInfo {
  std::string name;
  double sample_rate = 0.0;  ///< of focal points [Hz]
  int block_samples = 0;     ///< samples pulled at a time
  int max_foci = 0;
  bool intensity_per_focus = false;  ///< false: one intensity for all foci of a sample
  bool streams = false;              ///< pulls an endless stream
  bool loads_segments = false;       ///< plays segments that are loaded whole
  bool keeps_time = true;            ///< plays at its own times; false: when pull() says so
  int decimation = 1;                ///< samples of an emission to one of the device

  /// Of the samples that an emission makes for it [Hz].
  double emission_rate() const { return sample_rate * decimation; }
};

struct DeviceStats {
  std::int64_t blocks = 0;         ///< filled
  std::int64_t late_blocks = 0;    ///< filled after their deadline
  std::int64_t missed_blocks = 0;  ///< block times at which the queue had run dry
  int queue_blocks = 0;            ///< depth of the queue now
};

template <>
std::span<const Quantity<DeviceStats>> quantities<DeviceStats>();

enum class DeviceStatus : std::uint8_t {
  Idle,  ///< not started, or stopped
  Running,
  Refused,  ///< it would not start or take a segment; see Device::problem
  Vanished  ///< it was there and is gone: output has stopped, start() again when it is back
};

/// What a device that remembers its samples has played. Any thread.
class PlayedSamples {
 public:
  virtual ~PlayedSamples() = default;
  /// Samples first … first+n−1, sample-major. @throws std::out_of_range for samples that are
  /// forgotten or not yet played.
  virtual std::vector<FocusSample> read_back(std::int64_t first, std::int64_t n) const = 0;
};

/// Two ways in: an endless stream that pulls blocks at the device's own times (start), and segments
/// that are loaded whole and repeat until the next one (load_segment). start, stop, load_segment
/// and pull belong to one thread, all else to any.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceInfo& info() const = 0;
  virtual DeviceStatus status() const = 0;
  /// One sentence about why the status is Refused or Vanished.
  virtual std::string problem() const = 0;

  /// Starts to pull from `source`, which must outlive stop(). @return Running or Refused.
  virtual DeviceStatus start(SampleSource& source) = 0;
  virtual void stop() = 0;
  /// Plays n blocks now, fewer when it vanishes; nothing of a device that keeps time. @pre started.
  virtual void pull(int n) { static_cast<void>(n); }
  /// Loads samples (sample-major, `foci` a sample) that the device repeats. @return Running or
  /// Refused.
  virtual DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) = 0;

  virtual DeviceStats stats() const = 0;
  /// Samples of the stream that have left the array.
  virtual std::int64_t samples() const = 0;
  /// When a sample leaves the array, in seconds of the steady clock; of a device that keeps no
  /// time, since the first sample. @pre Running as a stream.
  virtual double play_time(std::int64_t sample) const = 0;
  /// When the block of a sample was asked for, likewise: play_time less what is queued before it.
  virtual double ask_time(std::int64_t sample) const { return play_time(sample); }
  /// What it played; null where it does not remember.
  virtual const PlayedSamples* played() const { return nullptr; }
};

}  // namespace prostm
