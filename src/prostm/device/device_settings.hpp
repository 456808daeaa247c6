#pragma once
/// Settings of devices: one object per type of settings, which a kind of device declares.

#include <any>
#include <map>
#include <typeindex>

#include "prostm/core/settings.hpp"

namespace prostm {

/// A value type: copies are independent. References stay valid for the object's lifetime.
class DeviceSettings {
 public:
  DeviceSettings();
  DeviceSettings(const DeviceSettings& other);
  DeviceSettings(DeviceSettings&& other) noexcept;
  DeviceSettings& operator=(const DeviceSettings& other);
  DeviceSettings& operator=(DeviceSettings&& other) noexcept;
  ~DeviceSettings();

  /// The settings of type S, initially its defaults.
  template <class S>
  S& of() {
    std::any& held = held_of(typeid(S));
    if (!held.has_value()) held = S();
    return *std::any_cast<S>(&held);
  }
  template <class S>
  const S& of() const {
    static const S kDefaults{};
    const std::any* held = find(typeid(S));
    return held == nullptr ? kDefaults : *std::any_cast<S>(held);
  }

 private:
  // compiled once: the settings of every stage are copied in many places
  std::any& held_of(std::type_index type);
  const std::any* find(std::type_index type) const;

  std::map<std::type_index, std::any> held_;
};

/// A type of settings and its name in files.
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

/// The group within `all`, which must outlive it: writable, and read-only.
inline SettingsGroup group_of(const DeviceSettingsGroup& group, DeviceSettings& all) {
  return group.change(group.name, all);
}
inline SettingsGroup group_of(const DeviceSettingsGroup& group, const DeviceSettings& all) {
  return group.read(group.name, all);
}

}  // namespace prostm
