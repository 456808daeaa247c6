#pragma once
/// Ultraleap arrays as a kind of device.

#include "prostm/device/device_kind.hpp"

namespace prostm {

DeviceKind ultraleap_kind();

}  // namespace prostm
