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
  bool keeps_time = true;            ///< paced by a clock of its own; false: by calls of pull()
  int decimation = 1;                ///< samples of an emission per sample of the device
  double place_unit = 0.0;           ///< resolution of positions [m]; 0: they are not rounded
  bool comes_back = false;           ///< resumes by itself after the status was Vanished

  /// Sample rate of an emission for this device [Hz].
  double emission_rate() const { return sample_rate * decimation; }
  /// Largest speed of a focal point that stays within kMaxFocusSpeed after positions are rounded
  /// [m/s]: rounding both ends of a step lengthens it by at most the diagonal of a cube of side
  /// place_unit.
  double max_focus_speed() const;
  /// Length of a block [s].
  double block_time() const { return block_samples / sample_rate; }
};

/// Result of a search for a device.
struct DeviceFinding {
  bool found = false;
  std::string words;  ///< one sentence: the device found, or what is missing and the remedy
};

struct DeviceStats {
  std::int64_t blocks = 0;         ///< blocks filled
  std::int64_t late_blocks = 0;    ///< blocks filled after their deadline
  std::int64_t missed_blocks = 0;  ///< block periods in which the queue was empty: dropouts
  std::int64_t lost_links = 0;     ///< times that the link to the array was lost
  std::int64_t lost_blocks = 0;    ///< of missed_blocks, those while the link was lost
  std::int64_t slow_blocks = 0;    ///< of missed_blocks, those caused by a slow link
  int queue_blocks = 0;            ///< current depth of the queue
};

template <>
std::span<const Quantity<DeviceStats>> quantities<DeviceStats>();

enum class DeviceStatus : std::uint8_t {
  Idle,  ///< not started, or stopped
  Running,
  Refused,  ///< did not start or take a segment; see Device::problem
  /// Lost while running; output has stopped. Call start() once the device is available again,
  /// unless DeviceInfo::comes_back is set.
  Vanished
};

/// Samples that a device has played and kept. Any thread.
class PlayedSamples {
 public:
  virtual ~PlayedSamples() = default;
  /// Returns samples first … first+n−1, sample-major. @throws std::out_of_range for samples that
  /// are no longer kept or not yet played.
  virtual std::vector<FocusSample> read_back(std::int64_t first, std::int64_t n) const = 0;
};

/// A device plays an endless stream, from which it pulls blocks at times of its own (start), or a
/// segment that is loaded whole and repeats until the next one replaces it (load_segment). One
/// thread calls start, stop, load_segment and pull; any thread may call the rest.
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
  /// Time when a sample leaves the array [s], on the steady clock; for a device without a clock of
  /// its own, since the first sample. @pre Running as a stream.
  virtual double play_time(std::int64_t sample) const = 0;
  /// Time when the block of a sample was requested [s], on the same clock: earlier than play_time
  /// by the time that the block spends in the queue.
  virtual double ask_time(std::int64_t sample) const { return play_time(sample); }
  /// Whether the hardware reports that it is too hot. Any thread.
  virtual bool is_hot() const { return false; }
  /// Short description of the connected device: versions, rates, times, load of the link.
  virtual std::string description() const { return {}; }
  /// The samples that were played; null if the device does not keep them.
  virtual const PlayedSamples* played() const { return nullptr; }
};

}  // namespace prostm
