// Libraries, devices and controls of the stand-in.
#include <algorithm>
#include <optional>

#include "world.hpp"

namespace ultraleap_stand_in {

World& world() {
  static World all;
  return all;
}

bool& in_callback() {
  thread_local bool inside = false;
  return inside;
}

Entry* World::find(const std::string& identifier) {
  for (Entry& entry : entries) {
    if (entry.array.identifier == identifier) return &entry;
  }
  return nullptr;
}

std::optional<ulh::Unexpected> World::refusal(const std::string& call) {
  const std::lock_guard lock(mutex);
  const auto found = refusals.find(call);
  if (found == refusals.end()) return std::nullopt;
  return failed(found->second);
}

void World::violate(const char* what) {
  ++violations;
  const std::lock_guard lock(mutex);
  violation = what;
}

void reset(const std::vector<Array>& arrays) {
  World& w = world();
  const std::lock_guard lock(w.mutex);
  w.entries.clear();
  for (const Array& array : arrays) w.entries.push_back({array, true, {}});
  w.listeners.clear();
  w.refusals.clear();
  w.sink = nullptr;
  w.service = true;
  w.manual = false;
  w.last_call_in_destructor = true;
  w.violation.clear();
  w.violations = 0;
  w.to_miss = 0;
  w.late = false;
  w.callbacks = 0;
}

void set_sink(Sink sink) {
  const std::lock_guard lock(world().mutex);
  world().sink = std::move(sink);
}
void set_service(bool runs) {
  world().service = runs;
}
void set_manual(bool manual) {
  world().manual = manual;
}

void claim(const std::string& identifier, const std::string& owner) {
  const std::lock_guard lock(world().mutex);
  world().find(identifier)->owner = owner;
}

namespace {

/// Notifies all listeners, without a lock on the world.
template <class Tell>
void tell(Tell&& what) {
  std::vector<std::shared_ptr<ulh::LibraryEventListener>> listeners;
  {
    const std::lock_guard lock(world().mutex);
    listeners = world().listeners;
  }
  for (const auto& listener : listeners) what(*listener);
}

}  // namespace

void disconnect(const std::string& identifier) {
  {
    const std::lock_guard lock(world().mutex);
    world().find(identifier)->connected = false;
  }
  tell([&](auto& listener) { listener.onDeviceDisconnected(identifier.c_str()); });
}

void reconnect(const std::string& identifier) {
  {
    const std::lock_guard lock(world().mutex);
    world().find(identifier)->connected = true;
  }
  tell([&](auto& listener) { listener.onDeviceConnected(identifier.c_str()); });
}

void rescind(const std::string& identifier, const std::string& new_owner) {
  claim(identifier, new_owner);
  tell([&](auto& listener) { listener.onDeviceModificationRightsRescinded(identifier.c_str()); });
}

void report_error(const std::string& identifier, int code) {
  tell([&](auto& listener) {
    listener.onDeviceErrorDetected(identifier.c_str(), static_cast<ulh::DeviceError>(code));
  });
}

void end_service() {
  world().service = false;
  tell([](auto& listener) { listener.onLibraryDisconnected(ulh::EndpointInfo("service")); });
}

void refuse(const std::string& call, const std::string& message) {
  const std::lock_guard lock(world().mutex);
  if (message.empty()) {
    world().refusals.erase(call);
  } else {
    world().refusals[call] = message;
  }
}

void miss(int n) {
  world().to_miss += n;
}
void make_late(bool late) {
  world().late = late;
}
void make_callback_late_in_destructor(bool wanted) {
  world().last_call_in_destructor = wanted;
}
int violations() {
  return world().violations;
}
std::string last_violation() {
  const std::lock_guard lock(world().mutex);
  return world().violation;
}
int emitters() {
  return world().emitters;
}
std::string owner(const std::string& identifier) {
  const std::lock_guard lock(world().mutex);
  return world().find(identifier)->owner;
}
long callbacks() {
  return world().callbacks;
}

}  // namespace ultraleap_stand_in

namespace Ultraleap::Haptics {

using ultraleap_stand_in::Entry;
using ultraleap_stand_in::failed;
using ultraleap_stand_in::kUs;
using ultraleap_stand_in::world;

const char* DeviceInfo::getModelName() const {
  return world().find(identifier_)->array.model.c_str();
}
const char* DeviceInfo::getModelDescription() const {
  return "Stand-in";
}
const char* DeviceInfo::getTransducerLayoutName() const {
  return world().find(identifier_)->array.layout.c_str();
}
const char* DeviceInfo::getFirmwareVersion() const {
  return world().find(identifier_)->array.firmware.c_str();
}
bool DeviceInfo::hasSupportFor(DeviceFeatures features) const {
  return features != DeviceFeatures::StreamingHaptics || world().find(identifier_)->array.streams;
}

TransducerContainer DeviceInfo::getTransducers() const {
  const Vector3 centre = world().find(identifier_)->array.centre;
  TransducerContainer out;
  for (int i = 0; i < 256; ++i) {
    const float x = 0.0105F * (static_cast<float>(i % 16) - 7.5F);
    const float y = 0.0105F * (static_cast<float>(i / 16) - 7.5F);
    out.push_back({Vector3(centre.x + x, centre.y + y, centre.z)});
  }
  return out;
}

result<DeviceInfo> Device::getInfo() const {
  return DeviceInfo(identifier_);
}

result<float> Device::getMinimumPointSeparation() const {
  if (auto refused = world().refusal("getMinimumPointSeparation")) return *refused;
  return world().find(identifier_)->array.separation;
}

result<DeviceClaimStatus> Device::getClaimStatus() const {
  const std::lock_guard lock(world().mutex);
  const std::string& owner = world().find(identifier_)->owner;
  if (owner.empty()) return DeviceClaimStatus::None;
  return owner == kUs ? DeviceClaimStatus::ThisClient : DeviceClaimStatus::OtherClient;
}

result<EndpointInfo> Device::getClaimOwner() const {
  const std::lock_guard lock(world().mutex);
  const std::string& owner = world().find(identifier_)->owner;
  if (owner.empty()) return failed("no client has a claim");
  return EndpointInfo(owner);
}

result<void> Library::connect(const char* path) {
  const std::string where = path;
  if (auto refused = world().refusal("connect")) return *refused;
  if (where != "direct" && !where.starts_with("local:")) return failed("unknown path");
  if (where != "direct" && !world().service) return failed("nobody listens");
  connected_ = true;
  return {};
}

result<void> Library::disconnect() {
  connected_ = false;
  return {};
}

bool Library::addEventListener(std::shared_ptr<LibraryEventListener> listener) {
  if (ultraleap_stand_in::in_callback()) world().violate("a listener was added in a callback");
  const std::lock_guard lock(world().mutex);
  world().listeners.push_back(std::move(listener));
  return true;
}

bool Library::removeEventListener(const std::shared_ptr<LibraryEventListener>& listener) {
  if (ultraleap_stand_in::in_callback()) world().violate("a listener was removed in a callback");
  const std::lock_guard lock(world().mutex);
  return std::erase(world().listeners, listener) > 0;
}

result<Device> Library::getDevice(const char* identifier) {
  if (!connected_) return failed("the library is not connected");
  const std::lock_guard lock(world().mutex);
  const Entry* entry = world().find(identifier);
  if (entry == nullptr || !entry->connected) return failed("no match");
  return Device(identifier);
}

result<Device> Library::findDevice(DeviceFeatures features) {
  if (!connected_) return failed("the library is not connected");
  const std::lock_guard lock(world().mutex);
  for (const Entry& entry : world().entries) {
    if (entry.connected && DeviceInfo(entry.array.identifier).hasSupportFor(features))
      return Device(entry.array.identifier);
  }
  return failed("no match");
}

result<std::vector<Device>> Library::getDevices() const {
  if (auto refused = world().refusal("getDevices")) return *refused;
  const std::lock_guard lock(world().mutex);
  std::vector<Device> out;
  for (const Entry& entry : world().entries) {
    if (entry.connected) out.emplace_back(entry.array.identifier);
  }
  return out;
}

}  // namespace Ultraleap::Haptics
