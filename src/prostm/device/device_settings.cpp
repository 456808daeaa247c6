#include "prostm/device/device_settings.hpp"

namespace prostm {

DeviceSettings::DeviceSettings() = default;
DeviceSettings::DeviceSettings(const DeviceSettings& other) = default;
DeviceSettings::DeviceSettings(DeviceSettings&& other) noexcept = default;
DeviceSettings& DeviceSettings::operator=(const DeviceSettings& other) = default;
DeviceSettings& DeviceSettings::operator=(DeviceSettings&& other) noexcept = default;
DeviceSettings::~DeviceSettings() = default;

std::any& DeviceSettings::held_of(std::type_index type) {
  return held_[type];
}

const std::any* DeviceSettings::find(std::type_index type) const {
  const auto found = held_.find(type);
  return found == held_.end() ? nullptr : &found->second;
}

}  // namespace prostm
