/// Hands of Leap Motion recordings.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "prostm/core/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/hand_file_parts.hpp"
#include "prostm/io/hand_file.hpp"
#include "prostm/track/live/leap_frame.hpp"

namespace prostm {
namespace {

using nlohmann::json;

/// `value` with the names that `structure` gives to its places: LeapJS packs a string as one value,
/// an object of one key as a nested list, and a list as an array of such lists.
json unpack(const JsonNode& structure, const JsonNode& value) {
  json object = json::object();
  if (value.array_size() != structure.array_size()) {
    value.fail(fmt::format("has {} values; the packing structure in frames[0] names {}",
                           value.array_size(), structure.array_size()));
  }
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
    if (inner.array_size() == 1 && inner.at(std::size_t{0}).value().is_array()) {
      json list = json::array();
      for (std::size_t n = 0; n < part.array_size(); ++n)
        list.push_back(unpack(inner.at(std::size_t{0}), part.at(n)));
      object[key] = std::move(list);
    } else {
      object[key] = unpack(inner, part);
    }
  }
  return object;
}

void append_leap_frame(const JsonNode& node, double& start, HandRecording& recording) {
  HandFrame frame = leap_frame(node);
  if (recording.frames.empty()) start = frame.time;
  const double time = frame.time - start;
  if (time > kMaxRecordingTime)
    node.fail("is more than a day after the first; timestamp must be in microseconds");
  append_frame(node, time, std::move(frame), recording);
}

}  // namespace

HandRecording hands_from_leap_json(std::string_view text, const std::string& name) {
  if (text.find_first_not_of(" \t\r\n") == text.npos) {
    throw InputError(name + ": is empty; it must be a Leap recording with \"frames\"");
  }
  const json document = parse_json(text, name);
  const JsonNode root(document, name);
  if (root.has("format") && root.at("format", "").value().is_string()) {
    const std::string format = root.at("format", "").text();
    const std::string_view words = words_of_format(format);
    if (!words.empty())
      refuse_as_hands(name, fmt::format("is a {} file ({}), not a hand recording", format, words));
  }
  const JsonNode frames = root.at("frames", "the recorded frames");

  HandRecording recording;
  double start = 0.0;
  const bool packed = frames.array_size() > 0 && frames.at(std::size_t{0}).value().is_array();
  for (std::size_t i = packed ? 1 : 0; i < frames.array_size(); ++i) {
    if (packed) {
      const json frame = unpack(frames.at(std::size_t{0}), frames.at(i));
      append_leap_frame(JsonNode(frame, name, fmt::format("frames[{}]", i)), start, recording);
    } else {
      append_leap_frame(frames.at(i), start, recording);
    }
  }
  require_frames(recording, name);
  if (root.has("source")) recording.description = root.at("source", "").text();
  return recording;
}

}  // namespace prostm
