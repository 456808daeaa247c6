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
  std::string address = {};  ///< behind NAME:// in --device; empty: the kind's usual one
  int foci = 4;              ///< focal points of a sample
  DeviceSettings settings = {};
};

/// A need of this machine, which `prostm devices` lists.
struct HostCheck {
  const char* name;          ///< "ipv6"
  DeviceFinding (*check)();  ///< found: the machine has it
};

struct DeviceKind {
  const char* name;     ///< in --device and settings, where an address may follow
  const char* address;  ///< form of the address in NAME://ADDRESS; null: NAME alone
  const char* array;    ///< name of the transducers that it has; null: any
  const char* tried;    ///< its needs, and how it was tried
  /// Returns the device's capabilities without touching it. Null if this version lacks the device.
  DeviceInfo (*info)(const DeviceSetup& setup);
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<Device> (*make)(const DeviceSetup& setup);
  /// Looks for the device at its address, for a second at most, without making it sound. Null where
  /// there is nothing to look for.
  DeviceFinding (*look)(const DeviceSetup& setup);
  /// Returns the transducers that it plays on, where settings of its own place them; null: those of
  /// `array`. @throws as make() does.
  TransducerArray (*transducers)(const DeviceSetup& setup) = nullptr;
  const DeviceSettingsGroup* settings = nullptr;  ///< null: none, or those of another kind
  const HostCheck* host = nullptr;                ///< null: any machine will do

  bool is_built() const { return make != nullptr; }
};

}  // namespace prostm
