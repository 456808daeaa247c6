#include "prostm/device/simulated/simulated_kind.hpp"

#include "prostm/device/simulated/simulated_array.hpp"

namespace prostm {
namespace {

DeviceInfo info(const DeviceSetup& setup) {
  return SimulatedArray::info_of(setup.settings.of<SimulatedArraySettings>(), setup.array);
}

std::unique_ptr<Device> make(const DeviceSetup& setup) {
  return std::make_unique<SimulatedArray>(setup.settings.of<SimulatedArraySettings>(), setup.array,
                                          setup.medium);
}

constexpr DeviceSettingsGroup kSettings =
    device_settings_group<SimulatedArraySettings>("simulated_array");

}  // namespace

DeviceKind simulated_kind() {
  return {.name = "sim",
          .address = nullptr,
          .array = nullptr,
          .tried = "needs no hardware; nobody can feel it",
          .info = info,
          .make = make,
          .look = nullptr,
          .settings = &kSettings};
}

}  // namespace prostm
