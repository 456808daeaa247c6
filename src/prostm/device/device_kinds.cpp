#include "prostm/device/device_kinds.hpp"

#include <stdexcept>
#include <vector>

#include "prostm/core/nearest_name.hpp"
#include "prostm/device/segment_stream.hpp"

namespace prostm {
namespace {

DeviceInfo simulated_info(const DeviceSetup& setup) {
  return SimulatedArray::info_of(setup.simulated, setup.array);
}

std::unique_ptr<Device> make_simulated(const DeviceSetup& setup) {
  return std::make_unique<SimulatedArray>(setup.simulated, setup.array, setup.medium);
}

constexpr DeviceKind kKinds[] = {
    {"sim", "needs no hardware; nobody can feel it", simulated_info, make_simulated},
    {"autd3", "never tried on real hardware", nullptr, nullptr},
    {"ultraleap", "needs the vendor's SDK; never tried on real hardware", nullptr, nullptr},
};

}  // namespace

std::span<const DeviceKind> device_kinds() {
  return kKinds;
}

const DeviceKind& device_kind(const std::string& name) {
  std::string built;
  std::vector<std::string> names;
  for (const DeviceKind& kind : kKinds) {
    names.emplace_back(kind.name);
    if (kind.is_built()) built += (built.empty() ? "" : ", ") + names.back();
  }
  for (const DeviceKind& kind : kKinds) {
    if (kind.name != name) continue;
    if (kind.is_built()) return kind;
    throw std::invalid_argument("device '" + name + "' is not built yet: it must be " + built);
  }
  throw std::invalid_argument("device '" + name + "' is unknown: it must be " + built +
                              did_you_mean(name, names));
}

std::unique_ptr<Device> make_device(const std::string& kind, const DeviceSetup& setup) {
  return as_stream(device_kind(kind).make(setup));
}

std::unique_ptr<Device> as_stream(std::unique_ptr<Device> device) {
  if (device->info().streams) return device;
  return std::make_unique<SegmentStream>(std::move(device));
}

}  // namespace prostm
