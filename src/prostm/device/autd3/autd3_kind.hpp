#pragma once
/// AUTD3 arrays of software version 38 as a kind of device.

#include "prostm/device/device_kind.hpp"

namespace prostm {

DeviceKind autd3_kind();

/// The transducers of all units in the settings. @throws InputError for a bad file of units.
TransducerArray autd3_transducers(const DeviceSetup& setup);

}  // namespace prostm
