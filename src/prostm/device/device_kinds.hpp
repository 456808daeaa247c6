#pragma once
/// The kinds of devices, for --device, settings and `prostm devices`.

#include <memory>
#include <span>
#include <string>

#include "prostm/device/device_kind.hpp"

namespace prostm {

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
