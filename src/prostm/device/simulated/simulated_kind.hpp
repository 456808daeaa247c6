#pragma once
/// The simulated array as a kind of device.

#include "prostm/device/device_kind.hpp"

namespace prostm {

DeviceKind simulated_kind();

}  // namespace prostm
