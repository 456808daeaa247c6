#pragma once
/// The kinds of devices, for --device, settings and `prostm devices`.

#include <memory>
#include <span>
#include <string>

#include "prostm/device/simulated_array.hpp"

namespace prostm {

/// Parts from which a device is made.
struct DeviceSetup {
  SimulatedArraySettings simulated;
  TransducerArray array;
  Medium medium;
};

struct DeviceKind {
  const char* name;   ///< in --device and settings
  const char* tried;  ///< its needs, and how it was tried
  /// Returns the device's capabilities without touching it. Null if this version lacks the device.
  DeviceInfo (*info)(const DeviceSetup& setup);
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<Device> (*make)(const DeviceSetup& setup);

  bool is_built() const { return make != nullptr; }
};

std::span<const DeviceKind> device_kinds();

/// @throws std::invalid_argument for a name that is unknown or not built, listing the built ones.
const DeviceKind& device_kind(const std::string& name);

/// Makes a device of this kind that streams: one that only loads segments gets a SegmentStream.
/// @throws as device_kind() and its make() do.
std::unique_ptr<Device> make_device(const std::string& kind, const DeviceSetup& setup);
/// The same for a given device.
std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device);

}  // namespace prostm
