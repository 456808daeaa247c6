#include "prostm/device/ultraleap/ultraleap.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace prostm {
namespace {

constexpr double kFullRate = 40e3;  // rate for which an emission's bounds are defined [Hz]
constexpr double kRounding = 1e-4;  // of rates that the SDK reports as floats

constexpr UltraleapKit kKits[] = {
    {"USX", nullptr, 0.121},
    {"USI", nullptr, -0.089},
    {"UHDK5", "square", 0.1105},
    {"UHDK5", "rect", 0.163},
};

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Arrays that were opened, by address and number of focal points.
struct Opened {
  std::mutex mutex;
  std::map<std::pair<std::string, int>, DeviceInfo> infos;
};

Opened& opened() {
  static Opened all;
  return all;
}

}  // namespace

UltraleapAddress ultraleap_address(const std::string& address) {
  const std::size_t mark = address.find('@');
  UltraleapAddress out{address.substr(0, mark), {}};
  if (mark == std::string::npos) return out;
  out.connection = address.substr(mark + 1);
  if (out.connection != "direct" && !out.connection.starts_with("local:")) {
    throw std::invalid_argument("the connection '" + out.connection + "' of ultraleap://" +
                                address + " is unknown: it must be direct or local:PATH");
  }
  return out;
}

const UltraleapKit* ultraleap_kit(std::string_view model, std::string_view layout) {
  const std::string name = lower(model), shape = lower(layout);
  for (const UltraleapKit& kit : kKits) {
    if (name != lower(kit.model)) continue;
    if (kit.layout == nullptr || shape.find(kit.layout) != std::string::npos) return &kit;
  }
  return nullptr;
}

int ultraleap_decimation(double rate) {
  return std::max(1, static_cast<int>(std::ceil(kFullRate / rate - kRounding)));
}

DeviceInfo ultraleap_info(const DeviceSetup& setup) {
  Opened& all = opened();
  const std::lock_guard lock(all.mutex);
  const auto found = all.infos.find({setup.address, setup.foci});
  if (found != all.infos.end()) return found->second;
  return {.name = "Ultraleap array",
          .sample_rate = kFullRate,
          .block_samples = 40,
          .max_foci = 8,
          .intensity_per_focus = true,
          .streams = true,
          .loads_segments = true};
}

void remember_ultraleap(const DeviceSetup& setup, const DeviceInfo& info) {
  Opened& all = opened();
  const std::lock_guard lock(all.mutex);
  all.infos[{setup.address, setup.foci}] = info;
  all.infos[{std::string(), setup.foci}] = info;  // for calls without an address
}

}  // namespace prostm
