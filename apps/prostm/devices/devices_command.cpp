#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <optional>

#include "common.hpp"
#include "devices/frame_budget.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/device/realtime_limits.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/track/live/leap_client.hpp"
#include "prostm/track/live/openxr_hands.hpp"

namespace prostm::app {
namespace {

constexpr int kNotFound = 1;  // exit status: a named item was not found
constexpr std::size_t kWidth = 100, kTextColumn = 33;

struct Row {
  std::string role, kind;
  bool available = false;
  std::string detail;
  std::optional<bool> found = {};  ///< nothing if it was not probed
  std::string words = {};          ///< result of probing
  std::string array = {};          ///< the transducers that a device implies
};

/// A row that is ready when probing ends.
using Looking = std::future<Row>;

/// Adds the result of probing, or the reason why it failed.
template <class Look>
Row looked(Row row, const Look& look) {
  try {
    const auto finding = look();
    row.found = finding.found;
    row.words = finding.words;
  } catch (const std::exception& error) {
    row.found = false;
    row.words = error.what();
  }
  return row;
}

DeviceSetup setup_of(const DeviceKind& kind, const std::string& address) {
  DeviceSetup setup;
  setup.array = kind.array != nullptr ? array_from_name(kind.array) : usx_array();
  setup.address = address;
  return setup;
}

/// A kind of device, not probed.
Row row_of(const DeviceKind& kind, const DeviceSetup& setup) {
  if (!kind.is_built()) {
    const char* missing = kind.look == nullptr ? "not built yet in this version; " : "";
    return {"array", kind.name, false, std::string(missing) + kind.tried};
  }
  const DeviceInfo info = kind.info(setup);
  return {"array", kind.name, true,
          fmt::format("--device {}: {}, {:.0f} Hz, blocks of {} samples, {} focal points, {}; {}",
                      form_of(kind), info.name, info.sample_rate, info.block_samples, info.max_foci,
                      info.intensity_per_focus ? "an intensity each" : "one intensity for all",
                      kind.tried)};
}

Looking look_for(const DeviceKind& kind, const std::string& address) {
  return std::async(std::launch::async, [&kind, address] {
    const DeviceSetup setup = setup_of(kind, address);
    Row row = row_of(kind, setup);
    if (kind.array != nullptr) row.array = kind.array;
    if (kind.look == nullptr) return row;
    return looked(row, [&] { return kind.look(setup); });
  });
}

Looking look_for_leap_at(const std::string& name) {
  return std::async(std::launch::async, [name] {
    const Row row{"hand", "leap", true,
                  fmt::format("--hand {}: tried with a server that replays recordings, never with "
                              "the real thing",
                              name)};
    return looked(row, [&] { return look_for_leap(leap_address(name)); });
  });
}

Looking look_for_openxr() {
  return std::async(std::launch::async, [] {
    const std::string problem = openxr_problem();
    return Row{"hand", "openxr", problem.empty(),
               (problem.empty() ? "--hand openxr: a runtime is here" : problem) +
                   "; tried with a runtime that replays recordings, never with a real one",
               problem.empty()};
  });
}

Looking known(Row row) {
  std::promise<Row> promise;
  promise.set_value(std::move(row));
  return promise.get_future();
}

/// Probes everything that this machine may have.
std::vector<Looking> look_around() {
  std::vector<Looking> looks;
  for (const DeviceKind& kind : device_kinds()) looks.push_back(look_for(kind, ""));
  looks.push_back(known({"hand", "scripted", true, "--hand scripted: needs nothing"}));
  looks.push_back(
      known({"hand", "study", true, "--hand study: a flat hand held still; needs nothing"}));
  looks.push_back(
      known({"hand", "recording", true,
             "--hand FILE: .hands.jsonl, or Leap JSON v6; tried with recordings of real hands"}));
  looks.push_back(known({"hand", "page", true, "--hand page --view: mouse, touch or keys"}));
  looks.push_back(look_for_leap_at("leap://127.0.0.1:6437"));
  looks.push_back(look_for_openxr());
  const RealtimeLimits limits = realtime_limits();
  looks.push_back(
      known({"system", "priority", limits.priority, priority_sentence(limits.priority)}));
  looks.push_back(known({"system", "memory", limits.memory, memory_sentence(limits.memory)}));
  for (const DeviceKind& kind : device_kinds()) {
    if (kind.host == nullptr) continue;
    const DeviceFinding host = kind.host->check();
    looks.push_back(known({"system", kind.host->name, host.found, host.words}));
  }
  return looks;
}

std::vector<Looking> look_at(const std::vector<std::string>& names) {
  std::vector<Looking> looks;
  // all names are checked before anything is probed
  for (const std::string& name : names) {
    if (name.starts_with("leap:")) {
      leap_address(name);
    } else if (name != "openxr") {
      device_named(name);
    }
  }
  for (const std::string& name : names) {
    if (name.starts_with("leap:")) {
      looks.push_back(look_for_leap_at(name));
    } else if (name == "openxr") {
      looks.push_back(look_for_openxr());
    } else {
      const DeviceName named = device_named(name);
      looks.push_back(look_for(*named.kind, named.address));
    }
  }
  return looks;
}

std::string state_of(const Row& row) {
  if (row.found && row.available) return *row.found ? "found" : "not found";
  return row.available ? "available" : "not available";
}

/// Breaks a text at its spaces so that no line ends beyond kWidth, if its words allow that.
std::string wrapped(const std::string& text) {
  std::string out;
  std::size_t column = kTextColumn;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size()), length = end - at;
    if (column > kTextColumn && column + 1 + length > kWidth) {
      out += "\n" + std::string(kTextColumn, ' ');
      column = kTextColumn;
    } else if (column > kTextColumn) {
      out += ' ';
      ++column;
    }
    out.append(text, at, length);
    column += length;
    at = end + 1;
  }
  return out;
}

nlohmann::ordered_json json_of(const Row& row) {
  nlohmann::ordered_json found = nullptr, words = nullptr, array = nullptr;
  if (!row.array.empty()) array = row.array;
  if (row.found) found = *row.found;
  if (!row.words.empty()) words = row.words;
  return {{"role", row.role},     {"kind", row.kind}, {"available", row.available},
          {"detail", row.detail}, {"found", found},   {"words", words},
          {"array", array}};
}

}  // namespace

int devices_command(const DevicesOptionsGiven& options) {
  if (options.budget) return frame_budget(options);
  std::vector<Looking> looks = options.names.empty() ? look_around() : look_at(options.names);
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  bool all_found = true;
  for (Looking& looking : looks) {
    const Row row = looking.get();
    const std::string text = row.words.empty() ? row.detail : row.words + "; " + row.detail;
    fmt::print(prose(options.json), "{:<6} {:<10} {:<14} {}\n", row.role, row.kind, state_of(row),
               wrapped(text));
    out.push_back(json_of(row));
    all_found = all_found && row.found.value_or(row.available);
  }
  write_json(options.json, out);
  return options.names.empty() || all_found ? 0 : kNotFound;
}

}  // namespace prostm::app
