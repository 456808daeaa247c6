#include "devices/frame_budget.hpp"

#include <fmt/format.h>

#include <span>
#include <string>
#include <vector>

#include "common.hpp"
#include "prostm/device/autd3/autd3_budget.hpp"

namespace prostm::app {
namespace {

constexpr std::size_t kLinks = 3;  // frames per ms in the table, the fastest index

/// Returns the share of a link, or "-" if blocks are not written in time.
std::string load_of(const Autd3Budget& row) {
  return row.urgency <= 1.0 ? fmt::format("{:.0f}", 1e2 * row.load) : "-";
}

void print_row(std::FILE* out, std::span<const Autd3Budget> rows) {
  const Autd3Budget& row = rows.front();
  fmt::print(out, "{:>5} {:>8} {:>6.1f} {:>6.2f} {:>6.0f} {:>8} {:>7}", row.slots, row.divider,
             1e-3 * row.sample_rate(), 1e3 * row.step(), 1e3 * row.block_time, row.block_samples,
             row.block_frames);
  for (const Autd3Budget& link : rows) fmt::print(out, " {:>6}", load_of(link));
  fmt::print(out, "\n");
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
      "slots, one of several with the same intensity takes one.\nThe step is that of a focal "
      "point at {:g} m/s. The last columns are the used share [%] of a link with so many frames "
      "per ms,\nincluding the frame that keeps a block audible; - is too much.\n\n",
      kAutd3DrawSpeed);
  const std::vector<Autd3Budget> rows = autd3_budgets();
  fmt::print(out, "{:>5} {:>8} {:>6} {:>6} {:>6} {:>8} {:>7}", "slots", "divider", "kHz", "mm",
             "ms", "samples", "frames");
  for (std::size_t link = 0; link < kLinks; ++link)
    fmt::print(out, " {:>3g}/ms", rows[link].frames_per_ms);
  fmt::print(out, "\n");
  for (std::size_t i = 0; i < rows.size(); i += kLinks)
    print_row(out, std::span(rows).subspan(i, kLinks));
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Autd3Budget& row : rows) json.push_back(json_of(row));
  write_json(options.json, json);
  return 0;
}

}  // namespace prostm::app
