#pragma once
/// Ultraleap arrays, through the vendor's Haptics SDK 3: addresses, kits and the device.
///
/// The SDK belongs to its vendor and is not part of prostm. Where CMake finds it
/// (cmake/ultraleap.cmake), PROSTM_ULTRALEAP is defined for the sources of the adapter.

#include <memory>
#include <string>
#include <string_view>

#include "prostm/device/device_kind.hpp"

namespace prostm {

/// Parts of the address in `ultraleap://ADDRESS`: `[DEVICE][@CONNECTION]`.
struct UltraleapAddress {
  std::string device;      ///< identifier, such as USX:00000001; empty: the first that can stream
  std::string connection;  ///< "direct", or "local:PATH" of a service; empty: the default service
};
/// @throws std::invalid_argument for a connection of another kind.
UltraleapAddress ultraleap_address(const std::string& address);

/// A development kit that mounts a tracker next to its array. Directions turn from the tracker's
/// frame T into D as (x, y, z)_T → (x, −z, y)_D; the origin of T is at (0, tracker_y, 0)_D.
struct UltraleapKit {
  const char* model;
  const char* layout;  ///< of the transducers; null: any
  double tracker_y;    ///< [m]
};
/// Returns the kit for the SDK's name of a model and a layout; null if there is no known kit.
const UltraleapKit* ultraleap_kit(std::string_view model, std::string_view layout);

/// Returns the number of emission samples per sample of the device: the smallest at which the
/// emission runs at 40 kHz or more, so that fades are as long and steps as short as at 40 kHz.
/// @param rate of the device [Hz].
int ultraleap_decimation(double rate);

/// Returns the capabilities of the array that this program opened last at that address (any address
/// if it is empty) with as many focal points. If it has opened none, assumes a rate of 40 kHz,
/// since only the array itself knows its rate.
DeviceInfo ultraleap_info(const DeviceSetup& setup);
void remember_ultraleap(const DeviceSetup& setup, const DeviceInfo& info);

/// Connects, claims the array and queries its rate. @throws std::invalid_argument with a sentence.
/// Only in builds with the SDK.
std::unique_ptr<Device> make_ultraleap(const DeviceSetup& setup);
/// Lists the arrays that the SDK sees and the programs that use them, without claiming one. `found`
/// if the requested array is present and free. Takes as long as the SDK takes to connect.
DeviceFinding look_for_ultraleap(const DeviceSetup& setup);

}  // namespace prostm
