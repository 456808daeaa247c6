// The AUTD3 SDK's units among the kinds of devices, and how their link is shared out.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/device/autd3_sdk/detail/autd3_sdk_discovery.hpp"
#include "prostm/device/device_kinds.hpp"

namespace prostm {
namespace {

constexpr double kCarrier = 40e3;  // [Hz], from which all sampling rates are divided
constexpr double kMostLoad = 0.5;
constexpr double kLongBlock = 20e-3, kShortBlock = 10e-3;  // [s]
constexpr int kLeastDivider = 4;                           // 10 kHz, above which nothing is gained
constexpr int kMostDivider = 20;  // 2 kHz, below which fingers feel the steps
constexpr int kTurnFrames = 2;    // that change over to a block and read the state
constexpr std::chrono::milliseconds kLook{500};

/// The setup without a look at the address; [autd3] is of units with either firmware.
Autd3SdkSetup shared_setup_of(const DeviceSetup& setup) {
  return {.address = setup.address,
          .units = setup.autd3.poses(),
          .medium = setup.medium,
          .foci = setup.foci,
          .own_intensities = setup.autd3.weights};
}

Autd3SdkSetup setup_of(const DeviceSetup& setup) {
  if (setup.address.empty())
    throw std::invalid_argument(
        "autd3-sdk needs the network interface of its units, as autd3-sdk://%eth0, or a "
        "simulator's address, as autd3-sdk://[::1]:44336");
  return shared_setup_of(setup);
}

std::string unit_words(const sdk::Unit& unit) {
  const auto& v = unit.info.firmware;
  return fmt::format(
      "firmware {}.{}.{}{}", v[0], v[1], v[2],
      (unit.info.flags & sdk::kAssigned) != 0 ? ", numbered by a program that may still run" : "");
}

}  // namespace

Autd3SdkBudget autd3_sdk_budget(int slots, int divider, double block_time, double frames_per_ms) {
  Autd3SdkBudget budget;
  budget.slots = slots;
  budget.divider = divider;
  budget.block_samples = static_cast<int>(std::lround(block_time * kCarrier / divider));
  const int words = budget.block_samples * slots;
  budget.block_frames = (words + sdk::kFociPerFrame - 1) / sdk::kFociPerFrame + kTurnFrames;
  budget.block_time = budget.block_samples * divider / kCarrier;
  budget.load = budget.block_frames / (1e3 * budget.block_time * frames_per_ms);
  return budget;
}

Autd3SdkBudget best_autd3_sdk_budget(int slots, double frames_per_ms) {
  for (int divider = kLeastDivider; divider <= kMostDivider; ++divider) {
    for (const double block_time : {kShortBlock, kLongBlock}) {
      const Autd3SdkBudget budget = autd3_sdk_budget(slots, divider, block_time, frames_per_ms);
      if (budget.load <= kMostLoad) return budget;
    }
  }
  throw std::invalid_argument(
      fmt::format("the link takes {:.2f} frames per ms, too few for {} slots at 2 kHz; use fewer "
                  "focal points or a faster network",
                  frames_per_ms, slots));
}

DeviceInfo autd3_sdk_info(const DeviceSetup& setup) {
  return Autd3SdkArray::info_of(shared_setup_of(setup));
}

std::unique_ptr<Device> make_autd3_sdk(const DeviceSetup& setup) {
  return std::make_unique<Autd3SdkArray>(setup_of(setup));
}

/// Asks without changing anything, so that a program that drives the units is not disturbed.
DeviceFinding look_for_autd3_sdk(const DeviceSetup& setup) {
  if (setup.address.empty())
    return {false,
            "name the network interface of the units to look for them, as "
            "autd3-sdk://%eth0"};
  try {
    const UdpAddress group = sdk::group_address(setup.address);
    UdpSocket socket;
    if (const std::string why = socket.open(group); !why.empty())
      return {false, fmt::format("autd3-sdk://{}: {}; IPv6 must be on there, which 'ip -6 address' "
                                 "shows and 'sysctl net.ipv6.conf.all.disable_ipv6=0' sets",
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
      return {false, fmt::format("a unit answers in wire version {}, and prostm speaks version {}; "
                                 "update it with the AUTD3 SDK 0.10",
                                 discovery.other_version(), sdk::kVersion)};
    return {false, "nobody answers: " + sdk::nobody_words(group)};
  } catch (const std::invalid_argument& error) {
    return {false, error.what()};
  }
}

}  // namespace prostm
