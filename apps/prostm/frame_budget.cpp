#include "frame_budget.hpp"

#include <fmt/format.h>

#include "common.hpp"
#include "prostm/device/autd3_budget.hpp"

namespace prostm::app {
namespace {

const char* judge(const Autd3Budget& row) {
  if (row.urgency <= 1.0) return "";
  return row.load <= 1.0 ? "no time left" : "too much";
}

void print_row(std::FILE* out, const Autd3Budget& row) {
  fmt::print(out, "{:>5} {:>8} {:>7.1f} {:>7.2f} {:>6.0f} {:>8} {:>7} {:>8.1f} {:>7.0f}  {}\n",
             row.slots, row.divider, 1e-3 * row.sample_rate(), 1e3 * row.step(),
             1e3 * row.block_time, row.block_samples, row.block_frames, row.frames_per_ms,
             1e2 * row.load, judge(row));
}

nlohmann::ordered_json json_of(const Autd3Budget& row) {
  return {{"slots", row.slots},
          {"divider", row.divider},
          {"sample_rate", row.sample_rate()},
          {"step_mm", 1e3 * row.step()},
          {"block_ms", 1e3 * row.block_time},
          {"block_samples", row.block_samples},
          {"block_frames", row.block_frames},
          {"frames_per_ms", row.frames_per_ms},
          {"load", row.load},
          {"fits", row.urgency <= 1.0}};
}

}  // namespace

int frame_budget(const DevicesOptionsGiven& options) {
  std::FILE* out = prose(options.json);
  fmt::print(
      out,
      "AUTD3 v38, a stream in blocks. A focal point with an intensity of its own takes two "
      "slots, one of several with the same intensity takes one.\nA sample of 40 kHz / divider "
      "moves a focal point of {:g} m/s by the step. The load counts the frame that keeps a "
      "block audible.\n\n",
      kAutd3DrawSpeed);
  fmt::print(out, "{:>5} {:>8} {:>7} {:>7} {:>6} {:>8} {:>7} {:>8} {:>7}\n", "slots", "divider",
             "kHz", "step", "block", "samples", "frames", "link", "load");
  fmt::print(out, "{:>5} {:>8} {:>7} {:>7} {:>6} {:>8} {:>7} {:>8} {:>7}\n", "", "", "", "mm", "ms",
             "", "", "per ms", "%");
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Autd3Budget& row : autd3_budgets()) {
    print_row(out, row);
    json.push_back(json_of(row));
  }
  write_json(options.json, json);
  return 0;
}

}  // namespace prostm::app
