#pragma once
/// A kind of device: a row of the table in device_kinds.hpp.

#include <memory>
#include <string>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/device_settings.hpp"

namespace prostm {

/// Parts from which a device is made.
struct DeviceSetup {
  TransducerArray array;
  Medium medium = {};
  std::string address = {};  ///< part after NAME:// in --device; empty: the kind's default
  int foci = 4;              ///< focal points of a sample
  DeviceSettings settings = {};
};

/// A requirement on this machine that `prostm devices` lists.
struct HostCheck {
  const char* name;          ///< "ipv6"
  DeviceFinding (*check)();  ///< found: the machine meets it
};

struct DeviceKind {
  const char* name;     ///< in --device and settings; an address may follow it
  const char* address;  ///< form of the address in NAME://ADDRESS; null: NAME alone
  const char* array;    ///< name of its transducer array; null: any
  const char* tried;    ///< requirements, and how it was tested
  /// Returns the device's capabilities without opening it. Null if this build lacks the device.
  DeviceInfo (*info)(const DeviceSetup& setup);
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<Device> (*make)(const DeviceSetup& setup);
  /// Searches for the device at its address, for at most a second and without any output. Null if
  /// there is nothing to search for.
  DeviceFinding (*look)(const DeviceSetup& setup);
  /// Returns the transducers as the kind's own settings place them; null: those of `array`. @throws
  /// as make() does.
  TransducerArray (*transducers)(const DeviceSetup& setup) = nullptr;
  const DeviceSettingsGroup* settings = nullptr;  ///< null: none, or those of another kind
  const HostCheck* host = nullptr;                ///< null: any machine will do

  bool is_built() const { return make != nullptr; }
};

}  // namespace prostm
