#pragma once
/// The kinds of devices, for --device, settings and `prostm devices`.

#include <memory>
#include <span>
#include <string>

#include "prostm/device/autd3/autd3_array.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/device/stream/stream_settings.hpp"

namespace prostm {

/// Parts from which a device is made.
struct DeviceSetup {
  SimulatedArraySettings simulated;
  TransducerArray array;
  Medium medium;
  std::string address = {};  ///< behind NAME:// in --device; empty: the kind's usual one
  int foci = 4;              ///< focal points of a sample
  Autd3Settings autd3 = {};
  StreamSettings stream = {};
};

struct DeviceKind {
  const char* name;     ///< in --device and settings, where an address may follow
  const char* address;  ///< form of the address in NAME://ADDRESS; null: NAME alone
  const char* array;    ///< name of the transducers that it has; null: any
  const char* tried;    ///< its needs, and how it was tried
  /// Returns the device's capabilities without touching it. Null if this version lacks the device.
  DeviceInfo (*info)(const DeviceSetup& setup);
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<Device> (*make)(const DeviceSetup& setup);
  /// Looks for the device at its address, for a second at most, without making it sound. Null where
  /// there is nothing to look for.
  DeviceFinding (*look)(const DeviceSetup& setup);
  /// Returns the transducers that it plays on, where settings of its own place them; null: those of
  /// `array`. @throws as make() does.
  TransducerArray (*transducers)(const DeviceSetup& setup) = nullptr;

  bool is_built() const { return make != nullptr; }
};

std::span<const DeviceKind> device_kinds();

/// How --device names a kind: NAME, or NAME://ADDRESS with the form of its address.
std::string form_of(const DeviceKind& kind);

/// A device as --device names it: NAME, or NAME://ADDRESS.
struct DeviceName {
  const DeviceKind* kind;
  std::string address;  ///< empty: none given
};
/// @throws std::invalid_argument for a name that is unknown or not built, listing the built ones,
/// and for an address where the kind takes none.
DeviceName device_named(const std::string& name);

/// Makes a device that streams: one that only loads segments gets a SegmentStream.
/// @param name as for device_named(). @throws as device_named() and the kind's make() do.
std::unique_ptr<Device> make_device(const std::string& name, const DeviceSetup& setup);
/// The same for a given device.
std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device);

}  // namespace prostm
