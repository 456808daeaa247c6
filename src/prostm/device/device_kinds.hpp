#pragma once
/// The kinds of devices, for --device, settings and `prostm devices`.

#include <memory>
#include <span>
#include <string>

#include "prostm/device/device_kind.hpp"

namespace prostm {

std::span<const DeviceKind> device_kinds();

/// Syntax of a kind in --device: NAME, or NAME://ADDRESS with the form of its address.
std::string form_of(const DeviceKind& kind);

/// A device as given to --device: NAME, or NAME://ADDRESS.
struct DeviceName {
  const DeviceKind* kind;
  std::string address;  ///< empty: none given
};
/// @throws std::invalid_argument for a name that is unknown or not built, listing the built ones,
/// and for an address where the kind takes none.
DeviceName device_named(const std::string& name);

/// Makes a device that streams; one that only loads segments is wrapped in a SegmentStream.
/// @param name as for device_named(). @throws as device_named() and the kind's make() do.
std::unique_ptr<Device> make_device(const std::string& name, const DeviceSetup& setup);
/// The same for a given device.
std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device);

}  // namespace prostm
