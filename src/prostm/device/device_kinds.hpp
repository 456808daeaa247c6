#pragma once
/// The devices that there are: what --device, settings and `prostm devices` know.

#include <memory>
#include <span>
#include <string>

#include "prostm/device/simulated_array.hpp"

namespace prostm {

/// What a device is made from.
struct DeviceSetup {
  SimulatedArraySettings simulated;
  TransducerArray array;
  Medium medium;
};

struct DeviceKind {
  const char* name;   ///< in --device and settings
  const char* tried;  ///< what it was tried with, or what it lacks
  /// What it will be able to do, without touching it. Null where this version has not built it.
  DeviceInfo (*info)(const DeviceSetup& setup);
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<Device> (*make)(const DeviceSetup& setup);

  bool is_built() const { return make != nullptr; }
};

std::span<const DeviceKind> device_kinds();

/// @throws std::invalid_argument for a name that none has or that is not built, with those there
/// are.
const DeviceKind& device_kind(const std::string& name);

/// A device of this kind that streams: one that loads segments only is driven through
/// SegmentStream. @throws as device_kind() and its make() do.
std::unique_ptr<Device> make_device(const std::string& kind, const DeviceSetup& setup);
/// The same of a device of one's own.
std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device);

}  // namespace prostm
