#pragma once
/// Devices that can be driven: arrays, real or simulated.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Capabilities of a device.
struct DeviceInfo {
  std::string name;
  double sample_rate = 0.0;  ///< sample rate of focal points [Hz]
  int block_samples = 0;     ///< samples pulled at a time
  int max_foci = 0;
  bool intensity_per_focus = false;  ///< false: one intensity for all foci of a sample
  bool streams = false;              ///< pulls an endless stream
  bool loads_segments = false;       ///< plays segments that are loaded whole
  bool keeps_time = true;            ///< plays at its own times; false: when pull() is called
  int decimation = 1;                ///< samples of an emission per sample of the device
  double place_unit = 0.0;           ///< unit that places are rounded to [m]; 0: none
  bool comes_back = false;           ///< plays on by itself after it was Vanished for a while

  /// Rate of the samples that an emission makes for it [Hz].
  double emission_rate() const { return sample_rate * decimation; }
  /// Speed of a focal point that is at most kMaxFocusSpeed once places are rounded: rounding both
  /// ends of a step lengthens it by at most the diagonal of a unit [m/s].
  double max_focus_speed() const;
  /// Length of a block [s].
  double block_time() const { return block_samples / sample_rate; }
};

/// Result of a look for a device.
struct DeviceFinding {
  bool found = false;
  std::string words;  ///< what is there; or what is missing and what to do, in one sentence
};

struct DeviceStats {
  std::int64_t blocks = 0;         ///< blocks filled
  std::int64_t late_blocks = 0;    ///< blocks filled after their deadline
  std::int64_t missed_blocks = 0;  ///< block times at which the queue had run dry
  std::int64_t lost_links = 0;     ///< times that the link to the array was lost
  std::int64_t lost_blocks = 0;    ///< of missed_blocks, those while the link was lost
  std::int64_t slow_blocks = 0;    ///< of missed_blocks, those that the link passed on too slowly
  int queue_blocks = 0;            ///< depth of the queue now
};

template <>
std::span<const Quantity<DeviceStats>> quantities<DeviceStats>();

enum class DeviceStatus : std::uint8_t {
  Idle,  ///< not started, or stopped
  Running,
  Refused,  ///< did not start or take a segment; see Device::problem
  /// Gone while running: output has stopped. Call start() when it is back, unless DeviceInfo says
  /// that it comes back by itself.
  Vanished
};

/// Samples that a device has played and remembers. Any thread.
class PlayedSamples {
 public:
  virtual ~PlayedSamples() = default;
  /// Returns samples first … first+n−1, sample-major. @throws std::out_of_range for samples that
  /// are forgotten or not yet played.
  virtual std::vector<FocusSample> read_back(std::int64_t first, std::int64_t n) const = 0;
};

/// A device plays an endless stream, from which it pulls blocks at its own times (start), or
/// segments that are loaded whole and repeat until the next one (load_segment). One thread calls
/// start, stop, load_segment and pull; any thread may call the rest.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceInfo& info() const = 0;
  virtual DeviceStatus status() const = 0;
  /// Says in one sentence why the status is Refused or Vanished.
  virtual std::string problem() const = 0;

  /// Starts to pull from `source`, which must outlive stop(). @return Running or Refused.
  virtual DeviceStatus start(SampleSource& source) = 0;
  virtual void stop() = 0;
  /// Plays n blocks now, fewer if the device vanishes; only for devices that do not keep time. Does
  /// nothing by default. @pre started.
  virtual void pull(int n) { static_cast<void>(n); }
  /// Loads samples (sample-major, `foci` a sample) that the device repeats. @return Running or
  /// Refused.
  virtual DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) = 0;

  virtual DeviceStats stats() const = 0;
  /// Samples of the stream that have left the array.
  virtual std::int64_t samples() const = 0;
  /// Time when a sample leaves the array, in seconds of the steady clock; for a device that keeps
  /// no time, since the first sample. @pre Running as a stream.
  virtual double play_time(std::int64_t sample) const = 0;
  /// Time when the block of a sample was asked for, likewise: play_time less the queue before it.
  virtual double ask_time(std::int64_t sample) const { return play_time(sample); }
  /// Whether the hardware says that it is too hot. Any thread.
  virtual bool is_hot() const { return false; }
  /// Says in a few words what was found out about it and what it costs: versions, rates, times.
  virtual std::string description() const { return {}; }
  /// The samples that it played; null if it does not remember them.
  virtual const PlayedSamples* played() const { return nullptr; }
};

}  // namespace prostm
