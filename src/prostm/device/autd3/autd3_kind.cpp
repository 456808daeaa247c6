#include "prostm/device/autd3/autd3_kind.hpp"

#include "prostm/device/autd3/autd3_array.hpp"
#include "prostm/device/detail/slot_encoder.hpp"

namespace prostm {
namespace {

constexpr std::uint16_t kUsualPort = 8080;

const Autd3Settings& settings_of(const DeviceSetup& setup) {
  return setup.settings.of<Autd3Settings>();
}

/// @throws InputError for a bad address or file of units.
Autd3Setup setup_of(const DeviceSetup& setup) {
  const Autd3Settings& settings = settings_of(setup);
  return {.address = setup.address.empty()
                         ? HostPort{"127.0.0.1", kUsualPort}
                         : host_port("autd3://" + setup.address, "autd3", kUsualPort),
          .units = settings.poses(),
          .medium = setup.medium,
          .foci = setup.foci,
          .own_intensities = settings.weights,
          .block_time = settings.block_time};
}

DeviceInfo info(const DeviceSetup& setup) {
  return Autd3Array::info_of(setup_of(setup));
}

std::unique_ptr<Device> make(const DeviceSetup& setup) {
  return std::make_unique<Autd3Array>(setup_of(setup));
}

DeviceFinding look(const DeviceSetup& setup) {
  return look_for_autd3(setup_of(setup));
}

constexpr DeviceSettingsGroup kSettings = device_settings_group<Autd3Settings>("autd3");

}  // namespace

TransducerArray autd3_transducers(const DeviceSetup& setup) {
  const std::vector<Pose> units = settings_of(setup).poses();
  return units.empty() ? autd3_array() : autd3_units(units);
}

DeviceKind autd3_kind() {
  return {.name = "autd3",
          .address = "HOST:PORT",
          .array = "autd3",
          .tried = "tried with a stand-in for AUTD3 v38, never with real units",
          .info = info,
          .make = make,
          .look = look,
          .transducers = autd3_transducers,
          .settings = &kSettings};
}

}  // namespace prostm
