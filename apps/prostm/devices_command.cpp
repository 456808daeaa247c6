#include <fmt/format.h>

#include "common.hpp"
#include "device/simulated_array.hpp"
#include "track/live/openxr_hands.hpp"

namespace prostm::app {

int devices_command(const DevicesOptionsGiven& options) {
  const SimulatedArray sim(SimulatedArraySettings{}, usx_array(), Medium{});
  const DeviceInfo& info = sim.info();
  const std::string openxr = openxr_problem();
  struct Row {
    const char* role;
    const char* kind;
    bool available;
    std::string detail;
  };
  const Row rows[] = {
      {"array", "sim", true,
       fmt::format("{}: {:.0f} Hz, blocks of {} samples, {} focal points, an intensity each",
                   info.name, info.sample_rate, info.block_samples, info.max_foci)},
      {"array", "autd3", false, "not built yet in this version; never tried on the real thing"},
      {"array", "ultraleap", false,
       "not built yet in this version (needs the vendor's SDK); never tried on the real thing"},
      {"hand", "scripted", true, "--hand scripted: needs nothing"},
      {"hand", "recording", true,
       "--hand FILE: .hands.jsonl, or Leap JSON v6; tried with recordings of real hands"},
      {"hand", "page", true, "--hand page --view: mouse, touch or keys"},
      {"hand", "leap", true,
       "--hand leap://127.0.0.1:6437: where a tracking service or its bridge runs, which was not "
       "looked for; tried with a server that replays recordings, never with the real thing"},
      {"hand", "openxr", openxr.empty(),
       (openxr.empty() ? "--hand openxr: a runtime is here" : openxr) +
           "; tried with a runtime that replays recordings, never with a real one"},
  };
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    fmt::print(prose(options.json), "{:<6} {:<10} {:<14} {}\n", row.role, row.kind,
               row.available ? "available" : "not available", row.detail);
    out.push_back({{"role", row.role},
                   {"kind", row.kind},
                   {"available", row.available},
                   {"detail", row.detail}});
  }
  write_json(options.json, out);
  return 0;
}

}  // namespace prostm::app
