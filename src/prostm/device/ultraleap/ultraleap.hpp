#pragma once
/// Arrays of Ultraleap, through the vendor's Haptics SDK 3: rows of the registry, names and kits.
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
  std::string device;      ///< identifier, as USX:00000001; empty: the first one that streams
  std::string connection;  ///< "direct", or "local:PATH" of a service; empty: the usual service
};
/// @throws std::invalid_argument for a connection of another kind.
UltraleapAddress ultraleap_address(const std::string& address);

/// A development kit that holds a tracker beside its array. With the tracker's frame T turned into
/// D's axes, (x, y, z)_T → (x, −z, y)_D, the tracker sits at (0, tracker_y, 0)_D.
struct UltraleapKit {
  const char* model;
  const char* layout;  ///< of the transducers; null: any
  double tracker_y;    ///< [m]
};
/// The kit of a model as the SDK names it, and of a layout; null if the model has no known kit.
const UltraleapKit* ultraleap_kit(std::string_view model, std::string_view layout);

/// Samples that the emission makes for each of a device's, so that fades last as long and steps are
/// as short as at 40 kHz: the fewest for which the emission runs at 40 kHz at least.
/// @param rate of the device [Hz].
int ultraleap_decimation(double rate);

/// The capabilities of the array that this program opened last at that address, or at any if it is
/// empty, and with as many focal points; before that, 40 kHz stands for the rate that only the
/// array itself can say.
DeviceInfo ultraleap_info(const DeviceSetup& setup);
void remember_ultraleap(const DeviceSetup& setup, const DeviceInfo& info);

/// Connects, claims the array and asks for its rate. @throws std::invalid_argument with a sentence.
/// Only where the SDK is.
std::unique_ptr<Device> make_ultraleap(const DeviceSetup& setup);
/// Lists the arrays that the SDK sees and who uses them, without claiming one. `found` if the
/// wanted one is there and free. As long as the SDK takes to connect.
DeviceFinding look_for_ultraleap(const DeviceSetup& setup);

}  // namespace prostm
