#include "prostm/device/device_kinds.hpp"

#include <stdexcept>
#include <string_view>
#include <vector>

#include "prostm/core/text/nearest_name.hpp"
#include "prostm/device/autd3/autd3_kind.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_kind.hpp"
#include "prostm/device/segment_stream.hpp"
#include "prostm/device/simulated/simulated_kind.hpp"
#include "prostm/device/stream/stream_kind.hpp"
#include "prostm/device/ultraleap/ultraleap_kind.hpp"

namespace prostm {
namespace {

// Each kind defines its row in its own folder.
const DeviceKind kKinds[] = {simulated_kind(), autd3_kind(), autd3_sdk_kind(), ultraleap_kind(),
                             stream_kind()};

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
