#include "prostm/device/stream/stream_kind.hpp"

#include <stdexcept>

#include "prostm/device/stream/detail/stream_sockets.hpp"
#include "prostm/device/stream/stream_device.hpp"

namespace prostm {
namespace {

HostPort address_of(const std::string& text) {
  return text.empty() ? HostPort{"127.0.0.1", StreamDevice::kUsualPort}
                      : host_port("stream://" + text, "stream", StreamDevice::kUsualPort);
}

const StreamSettings& settings_of(const DeviceSetup& setup) {
  return setup.settings.of<StreamSettings>();
}

DeviceInfo info(const DeviceSetup& setup) {
  return StreamDevice::info_of(settings_of(setup));
}

std::unique_ptr<Device> make(const DeviceSetup& setup) {
  return std::make_unique<StreamDevice>(settings_of(setup), address_of(setup.address));
}

DeviceFinding look(const DeviceSetup& setup) {
  const HostPort address = address_of(setup.address);
  try {
    stream::open_sockets(address);
  } catch (const std::invalid_argument& error) {
    return {false, error.what()};
  }
  const bool is_loopback =
      address.host.rfind("127.", 0) == 0 || address.host == "::1" || address.host == "localhost";
  return {true, address.text() + " is free: during a run, programs " +
                    (is_loopback ? "on this machine alone may subscribe"
                                 : "of any machine that reaches this address may subscribe")};
}

constexpr DeviceSettingsGroup kSettings = device_settings_group<StreamSettings>("stream");

}  // namespace

DeviceKind stream_kind() {
  return {.name = "stream",
          .address = "ADDRESS:PORT",
          .array = nullptr,
          .tried =
              "for programs that subscribe; tried with receivers on this machine, never with an "
              "array",
          .info = info,
          .make = make,
          .look = look,
          .settings = &kSettings};
}

}  // namespace prostm
