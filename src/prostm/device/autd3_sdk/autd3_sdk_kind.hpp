#pragma once
/// AUTD3 arrays with the firmware of the AUTD3 SDK as a kind of device.

#include "prostm/device/device_kind.hpp"

namespace prostm {

DeviceKind autd3_sdk_kind();

}  // namespace prostm
