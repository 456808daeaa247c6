#include "prostm/device/autd3_sdk/autd3_sdk_kind.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "prostm/device/autd3/autd3_array.hpp"
#include "prostm/device/autd3/autd3_kind.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/device/autd3_sdk/detail/autd3_sdk_discovery.hpp"

namespace prostm {
namespace {

constexpr std::chrono::milliseconds kLook{500};

/// Returns the setup without checking the address; [autd3] holds for units with either firmware.
Autd3SdkSetup shared_setup_of(const DeviceSetup& setup) {
  return {.address = setup.address,
          .units = setup.settings.of<Autd3Settings>().poses(),
          .medium = setup.medium,
          .foci = setup.foci,
          .own_intensities = setup.settings.of<Autd3Settings>().weights};
}

Autd3SdkSetup setup_of(const DeviceSetup& setup) {
  if (setup.address.empty())
    throw std::invalid_argument(
        "autd3-sdk needs the network interface of its units, such as autd3-sdk://%eth0, or a "
        "simulator's address, such as autd3-sdk://[::1]:44336");
  return shared_setup_of(setup);
}

std::string unit_words(const sdk::Unit& unit) {
  const auto& v = unit.info.firmware;
  return fmt::format(
      "firmware {}.{}.{}{}", v[0], v[1], v[2],
      (unit.info.flags & sdk::kAssigned) != 0 ? ", numbered by a program that may still run" : "");
}

DeviceInfo info(const DeviceSetup& setup) {
  return Autd3SdkArray::info_of(shared_setup_of(setup));
}

std::unique_ptr<Device> make(const DeviceSetup& setup) {
  return std::make_unique<Autd3SdkArray>(setup_of(setup));
}

/// Queries without changing anything, so as not to disturb a program that drives the units.
DeviceFinding look(const DeviceSetup& setup) {
  if (setup.address.empty())
    return {false,
            "name the network interface of the units to search for them, such as "
            "autd3-sdk://%eth0"};
  try {
    const UdpAddress group = sdk::group_address(setup.address);
    UdpSocket socket;
    if (const std::string why = socket.open(group); !why.empty())
      return {false, fmt::format("autd3-sdk://{}: {}; IPv6 must be on there: 'ip -6 address' "
                                 "shows it, 'sysctl net.ipv6.conf.all.disable_ipv6=0' sets it",
                                 setup.address, why)};
    sdk::Discovery discovery(socket, group);
    const std::vector<sdk::Unit> units = discovery.who_is_there(kLook);
    if (!units.empty()) {
      std::string words = fmt::format("{} unit{} answer{}", units.size(),
                                      units.size() == 1 ? "" : "s", units.size() == 1 ? "s" : "");
      for (const sdk::Unit& unit : units) words += "; " + unit_words(unit);
      return {true, words + "; units behind these answer once they are numbered"};
    }
    if (discovery.other_version() != 0)
      return {false, fmt::format("a unit answers in wire version {}, but prostm speaks version {}; "
                                 "update it with the AUTD3 SDK 0.10",
                                 discovery.other_version(), sdk::kVersion)};
    return {false, "no unit answers: " + sdk::nobody_words(group)};
  } catch (const std::invalid_argument& error) {
    return {false, error.what()};
  }
}

/// Returns the names of the interfaces with a link-local IPv6 address.
std::set<std::string> ipv6_interfaces() {
  constexpr const char* kLink = "20";  // the link-local scope
  std::ifstream file("/proc/net/if_inet6");
  std::set<std::string> names;
  std::string address, index, prefix, scope, flags, name;
  while (file >> address >> index >> prefix >> scope >> flags >> name) {
    if (scope == kLink) names.insert(name);
  }
  return names;
}

DeviceFinding check_ipv6() {
  const std::set<std::string> names = ipv6_interfaces();
  if (!names.empty()) {
    return {true,
            fmt::format("link-local addresses on {}, as autd3-sdk needs", fmt::join(names, ", "))};
  }
  return {false,
          "no interface has a link-local IPv6 address, which autd3-sdk needs: switch IPv6 on "
          "(sysctl net.ipv6.conf.all.disable_ipv6=0) and plug the cable in"};
}

constexpr HostCheck kIpv6{"ipv6", check_ipv6};

}  // namespace

DeviceKind autd3_sdk_kind() {
  return {.name = "autd3-sdk",
          .address = "%INTERFACE",
          .array = "autd3",
          .tried = "tried with a stand-in, never on real hardware",
          .info = info,
          .make = make,
          .look = look,
          .transducers = autd3_transducers,
          .host = &kIpv6};
}

}  // namespace prostm
