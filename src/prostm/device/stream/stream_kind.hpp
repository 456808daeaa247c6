#pragma once
/// A stream to programs that subscribe as a kind of device.

#include "prostm/device/device_kind.hpp"

namespace prostm {

DeviceKind stream_kind();

}  // namespace prostm
