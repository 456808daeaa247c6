#include <fmt/format.h>

#include "common.hpp"
#include "frame_budget.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/track/live/leap_client.hpp"
#include "prostm/track/live/openxr_hands.hpp"

namespace prostm::app {
namespace {

struct Row {
  std::string role, kind;
  bool available = false;
  std::string detail;
};

Row row_of(const DeviceKind& kind) {
  if (!kind.is_built())
    return {"array", kind.name, false,
            fmt::format("not built yet in this version; {}", kind.tried)};
  const DeviceInfo info = kind.info({SimulatedArraySettings{}, usx_array(), Medium{}});
  return {"array", kind.name, true,
          fmt::format("{}: {:.0f} Hz, blocks of {} samples, {} focal points, {}; {}", info.name,
                      info.sample_rate, info.block_samples, info.max_foci,
                      info.intensity_per_focus ? "an intensity each" : "one intensity for all",
                      kind.tried)};
}

}  // namespace

int devices_command(const DevicesOptionsGiven& options) {
  if (options.budget) return frame_budget(options);
  const std::string openxr = openxr_problem();
  std::vector<Row> rows;
  for (const DeviceKind& kind : device_kinds()) rows.push_back(row_of(kind));
  const Row hands[] = {
      {"hand", "scripted", true, "--hand scripted: needs nothing"},
      {"hand", "recording", true,
       "--hand FILE: .hands.jsonl, or Leap JSON v6; tried with recordings of real hands"},
      {"hand", "page", true, "--hand page --view: mouse, touch or keys"},
      {"hand", "leap", true,
       fmt::format("--hand leap://127.0.0.1:6437: not looked for; {}; tried with a server that "
                   "replays recordings, never with the real thing",
                   leap_needs())},
      {"hand", "openxr", openxr.empty(),
       (openxr.empty() ? "--hand openxr: a runtime is here" : openxr) +
           "; tried with a runtime that replays recordings, never with a real one"},
  };
  rows.insert(rows.end(), std::begin(hands), std::end(hands));
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
