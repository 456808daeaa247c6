/// Reads hands from Leap Motion recordings.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/detail/hand_collector.hpp"
#include "prostm/io/hand/detail/hand_lines.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/track/live/leap_frame.hpp"

namespace prostm {
namespace {

using nlohmann::json;

constexpr HandUnits kUnits = {"timestamp", 1e6, "microseconds", 1e3, "millimetres"};

/// Unpacks `value` with the names in `structure`: LeapJS packs a string as one value, an object of
/// one key as a nested list, and a list as an array of such lists. Values that do not match the
/// structure are kept unchanged, so that a fault affects only its hand.
json unpack(const JsonNode& structure, const JsonNode& value) {
  if (!value.value().is_array() || value.array_size() != structure.array_size())
    return value.value();
  json object = json::object();
  for (std::size_t i = 0; i < structure.array_size(); ++i) {
    const JsonNode entry = structure.at(i), part = value.at(i);
    if (entry.value().is_string()) {
      object[entry.text()] = part.value();
      continue;
    }
    if (!entry.value().is_object() || entry.value().size() != 1) {
      entry.fail("must be a name or an object with one key");
    }
    const std::string key = entry.value().begin().key();
    const JsonNode inner = entry.at(key.c_str(), "a list of names");
    const bool list = inner.array_size() == 1 && inner.at(std::size_t{0}).value().is_array();
    if (list && part.value().is_array()) {
      json rows = json::array();
      for (std::size_t n = 0; n < part.array_size(); ++n)
        rows.push_back(unpack(inner.at(std::size_t{0}), part.at(n)));
      object[key] = std::move(rows);
    } else {
      object[key] = list ? part.value() : unpack(inner, part);
    }
  }
  return object;
}

json unpack_frame(const JsonNode& structure, const JsonNode& value) {
  if (value.array_size() != structure.array_size()) {
    value.fail(fmt::format("has {} values; the packing structure in frames[0] names {}",
                           value.array_size(), structure.array_size()));
  }
  return unpack(structure, value);
}

/// Whether the first frame is LeapJS' packing structure: a list with names. (Other recordings nest
/// frames in lists.)
bool is_packed(const json& frames) {
  if (frames.empty() || !frames[0].is_array()) return false;
  return std::any_of(frames[0].begin(), frames[0].end(),
                     [](const json& entry) { return entry.is_string(); });
}

/// Records the size of the frame's hands as written, and its rate, whether or not they are valid.
void note_units(const json& frame, HandCollector& collector) {
  if (!frame.is_object()) return;
  const auto rate = frame.find("currentFrameRate");
  if (rate != frame.end() && rate->is_number()) collector.note_rate(rate->get<double>());
  const auto fingers = frame.find("pointables");
  if (fingers == frame.end() || !fingers->is_array() || fingers->size() < 5) return;
  const auto knuckle = [&](std::size_t i) {
    const json& finger = (*fingers)[i];
    const json p = finger.is_object() ? finger.value("mcpPosition", json()) : json();
    Vec3 x = Vec3::Constant(std::nan(""));
    for (std::size_t a = 0; p.is_array() && p.size() == 3 && a < 3; ++a) {
      const double value = p[a].is_number() ? p[a].get<double>() : 1e9;
      if (std::abs(value) < 1e6) x[static_cast<Eigen::Index>(a)] = value;  // in any unit
    }
    return x;
  };
  collector.note_span((knuckle(1) - knuckle(4)).norm());
}

/// Adds a frame, or the frames of a list; skips greetings and events of the service.
void take(const JsonNode& node, const std::string& where, HandCollector& collector) {
  if (node.value().is_array()) {
    for (std::size_t i = 0; i < node.array_size(); ++i)
      take(node.at(i), fmt::format("{}[{}]", where, i), collector);
    return;
  }
  if (is_leap_news(node)) return;
  note_units(node.value(), collector);
  collector.add(where, [&](const HandFrame* before, HandFaults& faults) {
    return leap_frame(node, before, faults);
  });
}

void take_packed(const JsonNode& frames, HandCollector& collector) {
  for (std::size_t i = 1; i < frames.array_size(); ++i) {
    const std::string where = fmt::format("frames[{}]", i);
    json frame;
    collector.add(where, [&](const HandFrame* before, HandFaults& faults) {
      frame = unpack_frame(frames.at(std::size_t{0}), frames.at(i));
      note_units(frame, collector);
      return leap_frame(JsonNode(frame, frames.file(), where), before, faults);
    });
  }
}

/// Adds the messages of the service, one per line.
void take_lines(std::string_view text, const std::string& name, const ReadProgress& progress,
                HandCollector& collector) {
  const std::size_t all = text.size();
  std::size_t line = 0;
  for (std::string_view content = next_line(text, line); !content.empty();
       content = next_line(text, line)) {
    const std::string place = fmt::format("line {}", line), where = name + ", " + place;
    json document;
    try {
      document = parse_json(content, where);
    } catch (const InputError& error) {
      collector.add(place, [&](const HandFrame*, HandFaults&) -> HandFrame { throw error; });
      continue;
    }
    take(JsonNode(document, where), place, collector);
    if (progress) progress(all - text.size(), all);
  }
}

void refuse_other_formats(const JsonNode& root) {
  if (!root.has("format") || !root.at("format", "").value().is_string()) return;
  const std::string format = root.at("format", "").text();
  const std::string_view words = words_of_format(format);
  if (!words.empty()) {
    refuse_as_hands(root.file(),
                    fmt::format("is a {} file ({}), not a hand recording", format, words));
  }
}

}  // namespace

HandRecording hands_from_leap_json(std::string_view text, const std::string& name,
                                   const ReadProgress& progress) {
  text = without_mark(text);
  if (text.find_first_not_of(" \t\r\n") == text.npos) {
    throw InputError(name + ": is empty; it must be a Leap recording with \"frames\"");
  }
  HandCollector collector(name, kUnits);
  if (has_value_a_line(text)) {
    take_lines(text, name, progress, collector);
    return collector.finish();
  }
  const json document = parse_json(text, name);
  const JsonNode root(document, name);
  std::string description;
  if (document.is_array() || root.has("hands")) {
    take(root, "frames", collector);
  } else {
    refuse_other_formats(root);
    const JsonNode frames = root.at("frames", "the recorded frames");
    frames.array_size();
    if (is_packed(frames.value())) {
      take_packed(frames, collector);
    } else {
      take(frames, "frames", collector);
    }
    if (root.has("source")) description = root.at("source", "").text();
  }
  HandRecording recording = collector.finish();
  recording.description = description;
  return recording;
}

}  // namespace prostm
