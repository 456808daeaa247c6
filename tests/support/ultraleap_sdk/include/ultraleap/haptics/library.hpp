#pragma once
/// Library, devices and events of the stand-in.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ultraleap/haptics/geometry.hpp"
#include "ultraleap/haptics/result.hpp"

namespace Ultraleap::Haptics {

enum class DeviceFeatures : unsigned { None = 0, BasicHaptics = 1, StreamingHaptics = 2 };
enum class DeviceClaimStatus { None, ThisClient, OtherClient };
enum class DeviceError : int {};

class AppVersionInfo {
 public:
  explicit AppVersionInfo(const char* name) : name_(name) {}
  std::string name() const { return name_; }

 private:
  std::string name_;
};

class EndpointInfo {
 public:
  explicit EndpointInfo(const std::string& name) : version_(name.c_str()) {}
  AppVersionInfo version() const { return version_; }

 private:
  AppVersionInfo version_;
};

class DeviceInfo {
 public:
  explicit DeviceInfo(std::string identifier) : identifier_(std::move(identifier)) {}
  const char* getIdentifier() const { return identifier_.c_str(); }
  const char* getModelName() const;
  const char* getModelDescription() const;
  const char* getTransducerLayoutName() const;
  const char* getFirmwareVersion() const;
  TransducerContainer getTransducers() const;
  bool hasSupportFor(DeviceFeatures features) const;

 private:
  std::string identifier_;
};

class Device {
 public:
  explicit Device(std::string identifier) : identifier_(std::move(identifier)) {}
  const char* getIdentifier() const { return identifier_.c_str(); }
  result<DeviceInfo> getInfo() const;
  result<float> getMinimumPointSeparation() const;
  result<DeviceClaimStatus> getClaimStatus() const;
  result<EndpointInfo> getClaimOwner() const;

 private:
  std::string identifier_;
};

class LibraryEventListener {
 public:
  virtual ~LibraryEventListener() = default;
  virtual void onDeviceConnected(const char*) {}
  virtual void onDeviceDisconnected(const char*) {}
  virtual void onDeviceModificationRightsClaimed(const char*) {}
  virtual void onDeviceModificationRightsRescinded(const char*) {}
  virtual void onDeviceErrorDetected(const char*, DeviceError) {}
  virtual void onDeviceErrorCleared(const char*, DeviceError) {}
  virtual void onLibraryConnected(const EndpointInfo&) {}
  virtual void onLibraryDisconnected(const EndpointInfo&) {}
};

class Library {
 public:
  explicit Library(const AppVersionInfo& app) : app_(app) {}
  result<void> connect() { return connect("local:"); }
  result<void> connect(const char* path);
  result<void> disconnect();
  bool addEventListener(std::shared_ptr<LibraryEventListener> listener);
  bool removeEventListener(const std::shared_ptr<LibraryEventListener>& listener);
  result<Device> getDevice(const char* identifier);
  result<Device> findDevice(DeviceFeatures features);
  result<std::vector<Device>> getDevices() const;

 private:
  AppVersionInfo app_;
  bool connected_ = false;
};

}  // namespace Ultraleap::Haptics
