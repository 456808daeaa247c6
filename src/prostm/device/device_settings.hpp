#pragma once
/// The settings of devices: an object of each type, which the kind of device that has it declares.

#include <any>
#include <map>
#include <typeindex>

#include "prostm/core/settings.hpp"

namespace prostm {

/// A value: copies are independent of each other. References stay valid as long as it lives.
class DeviceSettings {
 public:
  /// The settings of type S; before anything was set, its defaults.
  template <class S>
  S& of() {
    std::any& held = held_[typeid(S)];
    if (!held.has_value()) held = S();
    return *std::any_cast<S>(&held);
  }
  template <class S>
  const S& of() const {
    static const S kDefaults{};
    const auto found = held_.find(typeid(S));
    return found == held_.end() ? kDefaults : *std::any_cast<S>(&found->second);
  }

 private:
  std::map<std::type_index, std::any> held_;
};

/// A type of settings under its name in files.
struct DeviceSettingsGroup {
  const char* name;
  SettingsGroup (*change)(const char* name, DeviceSettings& all);
  SettingsGroup (*read)(const char* name, const DeviceSettings& all);
};

template <class S>
constexpr DeviceSettingsGroup device_settings_group(const char* name) {
  return {name, [](const char* n, DeviceSettings& all) { return group_of(n, all.of<S>()); },
          [](const char* n, const DeviceSettings& all) { return group_of(n, all.of<S>()); }};
}

/// The group in settings that outlive it, to change and to read alone.
inline SettingsGroup group_of(const DeviceSettingsGroup& group, DeviceSettings& all) {
  return group.change(group.name, all);
}
inline SettingsGroup group_of(const DeviceSettingsGroup& group, const DeviceSettings& all) {
  return group.read(group.name, all);
}

}  // namespace prostm
