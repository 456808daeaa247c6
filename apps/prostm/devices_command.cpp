#include <fmt/format.h>

#include "common.hpp"
#include "device/simulated_array.hpp"

namespace prostm::app {

int devices_command(const std::string& json) {
  const SimulatedArray sim(SimulatedArraySettings{}, usx_array(), Medium{});
  const DeviceInfo& info = sim.info();
  struct Row {
    const char* kind;
    bool available;
    std::string detail;
  };
  const Row rows[] = {
      {"sim", true,
       fmt::format("{}: {:.0f} Hz, blocks of {} samples, {} focal points, an intensity each",
                   info.name, info.sample_rate, info.block_samples, info.max_foci)},
      {"autd3", false, "not built yet in this version; never tried on the real thing"},
      {"ultraleap", false,
       "not built yet in this version (needs the vendor's SDK); never tried on the real thing"},
  };
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    fmt::print(prose(json), "{:<10} {:<14} {}\n", row.kind,
               row.available ? "available" : "not available", row.detail);
    out.push_back({{"kind", row.kind}, {"available", row.available}, {"detail", row.detail}});
  }
  write_json(json, out);
  return 0;
}

}  // namespace prostm::app
