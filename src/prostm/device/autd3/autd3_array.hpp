#pragma once
/// AUTD3 arrays of software version 38, over its remote protocol.

#include <memory>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/geometry.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/core/text/host_port.hpp"
#include "prostm/device/autd3/autd3_budget.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

struct Autd3Settings {
  std::string
      units;  ///< a file of poses (prostm-autd3/1); empty: one unit, its middle at D's origin
  double block_time = 0.0;  ///< [s], 10 to 25 ms; 0: 10 ms if the link allows it, else 20 ms
  /// Each of up to four focal points has its own intensity and takes two slots; false: up to eight
  /// focal points share the largest intensity.
  bool weights = true;

  /// Poses X_DU of the units' own frames; empty if no file is named.
  /// @throws InputError for a bad file.
  std::vector<Pose> poses() const;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

struct Autd3Setup {
  HostPort address{"127.0.0.1", 8080};
  /// Poses X_DU of the units' own frames, up to 64; empty: one unit, its middle at D's origin.
  std::vector<Pose> units = {};
  Medium medium = {};
  int foci = 4;  ///< focal points of a sample
  bool own_intensities = true;
  double block_time = 0.0;  ///< as in Autd3Settings
};

/// Streams to AUTD3 units, or makes them repeat loops.
///
/// The firmware plays two segments in turn. Each block of the stream is written to the idle
/// segment, followed by a modulation that makes the block audible until its end. So output falls
/// silent by itself within two blocks if no more data arrives. A loop is kept audible for 60 ms at
/// a time. A separate process holds the connection, and silences the units as soon as this process
/// ends in any way. A lost connection is reopened, and output resumes; until then the status is
/// Vanished.
class Autd3Array final : public Device {
 public:
  /// Connects, and measures the link.
  /// @throws std::invalid_argument with a sentence if that fails or the focal points do not fit.
  explicit Autd3Array(const Autd3Setup& setup);
  ~Autd3Array() override;

  /// Info of an array whose link takes one frame per ms, without connecting to it.
  /// @throws std::invalid_argument if the focal points do not fit.
  static DeviceInfo info_of(const Autd3Setup& setup);

  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// Loads a closed loop for all focal points, of at most as many samples as fit into 65 536 slots.
  /// The loop starts at once: at the current sample if it has the length of the playing loop and no
  /// focal point jumps, otherwise in a short silence. Refused while a stream plays.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;
  bool is_hot() const override;
  /// Versions of the firmware, measured frames per ms, and what the session costs.
  std::string description() const override;

  const Autd3Budget& budget() const;
  int link_process() const;  ///< its id; 0 without a link

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Searches for units for about a second, without changing their output.
DeviceFinding look_for_autd3(const Autd3Setup& setup);

/// Reads poses of units, {"format": "prostm-autd3/1", "units": [{"position_mm": [x, y, z],
/// "quaternion": [x, y, z, w]}, …]}: position of the middle of each unit in D, and its orientation.
/// @return X_DU of their own frames, whose origin is transducer 0.
/// @throws InputError with a sentence.
std::vector<Pose> autd3_units_from_json(std::string_view text, const std::string& file);

}  // namespace prostm
