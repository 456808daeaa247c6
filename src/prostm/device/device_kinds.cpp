#include "prostm/device/device_kinds.hpp"

#include <stdexcept>
#include <string_view>
#include <vector>

#include "prostm/core/text/nearest_name.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/device/segment_stream.hpp"
#include "prostm/device/stream/stream_device.hpp"
#include "prostm/device/ultraleap/ultraleap.hpp"

namespace prostm {
namespace {

DeviceInfo simulated_info(const DeviceSetup& setup) {
  return SimulatedArray::info_of(setup.simulated, setup.array);
}

std::unique_ptr<Device> make_simulated(const DeviceSetup& setup) {
  return std::make_unique<SimulatedArray>(setup.simulated, setup.array, setup.medium);
}

DeviceInfo autd3_info(const DeviceSetup& setup) {
  return Autd3Array::info_of(autd3_setup(setup));
}

std::unique_ptr<Device> make_autd3(const DeviceSetup& setup) {
  return std::make_unique<Autd3Array>(autd3_setup(setup));
}

DeviceFinding look_for_autd3_units(const DeviceSetup& setup) {
  return look_for_autd3(autd3_setup(setup));
}

constexpr DeviceKind kKinds[] = {
    {"sim", nullptr, nullptr, "needs no hardware; nobody can feel it", simulated_info,
     make_simulated, nullptr},
    {"autd3", "HOST:PORT", "autd3", "tried with a stand-in for AUTD3 v38, never with real units",
     autd3_info, make_autd3, look_for_autd3_units, autd3_transducers},
    {"autd3-sdk", "%INTERFACE", "autd3", "tried with a stand-in, never on real hardware",
     autd3_sdk_info, make_autd3_sdk, look_for_autd3_sdk, autd3_transducers},
#if defined(PROSTM_ULTRALEAP)
    {"ultraleap", "[DEVICE][@CONNECTION]", "usx",
     "this build has the vendor's SDK; tried with a stand-in of its interface, never on real "
     "hardware",
     ultraleap_info, make_ultraleap, look_for_ultraleap},
#else
    {"ultraleap", "[DEVICE][@CONNECTION]", "usx",
     "this build lacks the vendor's Haptics SDK 3: install that and configure prostm with "
     "-DPROSTM_ULTRALEAP_ROOT=FOLDER (docs/ultraleap.md); never tried on real hardware",
     nullptr, nullptr, look_for_ultraleap},
#endif
    {"stream", "ADDRESS:PORT", nullptr,
     "for programs that subscribe; tried with receivers on this machine, never with an array",
     stream_info, make_stream, look_for_stream},
};

const DeviceKind& kind_named(const std::string& name) {
  std::string built;
  std::vector<std::string> names;
  for (const DeviceKind& kind : kKinds) {
    names.emplace_back(kind.name);
    if (kind.is_built()) built += (built.empty() ? "" : ", ") + form_of(kind);
  }
  for (const DeviceKind& kind : kKinds) {
    if (kind.name != name) continue;
    if (kind.is_built()) return kind;
    throw std::invalid_argument("device '" + name + "' is not in this build: it must be " + built +
                                "; " + kind.name + ": " + kind.tried);
  }
  throw std::invalid_argument("device '" + name + "' is unknown: it must be " + built +
                              did_you_mean(name, names));
}

}  // namespace

std::span<const DeviceKind> device_kinds() {
  return kKinds;
}

std::string form_of(const DeviceKind& kind) {
  return kind.address == nullptr ? kind.name : std::string(kind.name) + "://" + kind.address;
}

DeviceName device_named(const std::string& name) {
  constexpr std::string_view kMark = "://";
  const std::size_t mark = name.find(kMark);
  const DeviceKind& kind = kind_named(name.substr(0, mark));
  if (mark == std::string::npos) return {&kind, {}};
  if (kind.address == nullptr) {
    throw std::invalid_argument("device '" + name + "' must be " + kind.name +
                                " alone: it has no address");
  }
  return {&kind, name.substr(mark + kMark.size())};
}

std::unique_ptr<Device> make_device(const std::string& name, const DeviceSetup& setup) {
  const DeviceName named = device_named(name);
  DeviceSetup addressed = setup;
  addressed.address = named.address;
  return as_stream(named.kind->make(addressed));
}

std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device) {
  if (device->info().streams) return device;
  return std::make_unique<SegmentStream>(std::move(device));
}

}  // namespace prostm
