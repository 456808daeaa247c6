#include "prostm/io/hand_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/file.hpp"
#include "prostm/core/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/hand_file_parts.hpp"
#include "prostm/track/hand_json.hpp"

namespace prostm {
namespace {

using nlohmann::json;

constexpr double kMaxHandDistance = 10.0;  // farther than any tracker sees [m]
constexpr std::size_t kMaxRecordingBytes = std::size_t{256} << 20;

/// An array of exactly `count` numbers.
JsonNode numbers(const JsonNode& hand, const char* key, std::size_t count, const char* meaning) {
  const JsonNode node = hand.at(key, meaning);
  if (node.array_size() != count) {
    node.fail(
        fmt::format("has {} numbers; it must have {}: {}", node.array_size(), count, meaning));
  }
  return node;
}

Quat unit_quaternion(const JsonNode& node, std::size_t joint) {
  const auto part = [&](std::size_t i) { return node.at(4 * joint + i).number(-2.0, 2.0); };
  const Quat q(part(3), part(0), part(1), part(2));
  const double norm = q.norm();
  if (!(std::abs(norm - 1.0) <= 0.01)) {
    node.fail(fmt::format("has a quaternion of length {} at joint {}; it must be 1 within 0.01",
                          norm, joint_name(static_cast<int>(joint))));
  }
  return Quat(q.coeffs() / norm);
}

Side side_of(const JsonNode& node) {
  const std::string side = node.text();
  if (side != "L" && side != "R")
    node.fail(fmt::format("is \"{}\"; it must be \"L\" or \"R\"", side));
  return side == "L" ? Side::Left : Side::Right;
}

Hand neutral_hand(const JsonNode& node) {
  Hand hand;
  hand.id = node.at("id", "a whole number").integer(0, std::numeric_limits<int>::max());
  hand.side = side_of(node.at("side", "\"L\" or \"R\""));
  if (node.has("conf")) hand.confidence = node.at("conf", "").number(0.0, 1.0);
  if (node.has("inferred"))
    hand.inferred = static_cast<std::uint32_t>(node.at("inferred", "").integer(0, 3));
  const JsonNode p = numbers(node, "p", 3 * kJointCount, "x, y, z of 26 joints in metres");
  const JsonNode q =
      numbers(node, "q", 4 * kJointCount, "unit quaternions x, y, z, w of 26 joints");
  const JsonNode r = numbers(node, "r", kJointCount, "radii of 26 joints in metres");
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (std::size_t a = 0; a < 3; ++a) {
      hand.position[j][static_cast<Eigen::Index>(a)] =
          p.at(3 * j + a).number(-kMaxHandDistance, kMaxHandDistance);
    }
    hand.orientation[j] = unit_quaternion(q, j);
    hand.radius[j] = r.at(j).number(-1.0, 1.0);
    hand.velocity[j] = Vec3::Zero();
  }
  check_hand(node, hand);
  return hand;
}

void check_header(const JsonNode& header) {
  require_format(header, "hand-frames");
  header.at("version", "1").integer(1, 1);
  if (const std::string units = header.at("units", "\"m\"").text(); units != "m") {
    header.at("units", "\"m\"").fail(fmt::format("is \"{}\"; it must be \"m\"", units));
  }
  if (!header.has("joints")) return;
  const JsonNode joints = header.at("joints", "");
  if (joints.array_size() != kJointCount) {
    joints.fail(fmt::format("names {} joints; it must name the 26 of OpenXR", joints.array_size()));
  }
  for (int j = 0; j < kJointCount; ++j) {
    const JsonNode name = joints.at(static_cast<std::size_t>(j));
    if (name.text() != joint_name(j))
      name.fail(fmt::format("must be \"{}\" (OpenXR's order)", joint_name(j)));
  }
}

/// The next line that is not blank, cut from `text`; empty at the end. `line` counts from 1.
std::string_view next_line(std::string_view& text, std::size_t& line) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view found = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line;
    if (found.find_first_not_of(" \t\r") != found.npos) return found;
  }
  return {};
}

}  // namespace

void append_frame(const JsonNode& node, double time, HandFrame frame, HandRecording& recording) {
  if (!recording.frames.empty() && !(time > recording.frames.back().time)) {
    node.fail(fmt::format(
        "is {:.6f} s after the first frame, the frame before it {:.6f} s; time must increase", time,
        recording.frames.back().time));
  }
  check_ids(node, frame);
  frame.time = time;
  recording.frames.push_back(std::move(frame));
}

void refuse_as_hands(const std::string& name, const std::string& what) {
  throw InputError(name + " " + what +
                   "; a hand recording is hand-frames JSON Lines (.hands.jsonl) or a recording of "
                   "a Leap (.json), see docs/hands.md");
}

void require_frames(const HandRecording& recording, const std::string& name) {
  if (recording.frames.empty())
    throw InputError(name + ": holds 0 frames; a recording must have at least 1");
}

HandRecording hands_from_jsonl(std::string_view text, const std::string& name,
                               const ReadProgress& progress) {
  const std::size_t all = text.size();
  std::size_t line = 0;
  const std::string_view first = next_line(text, line);
  if (first.empty())
    throw InputError(name + ": is empty; the first line must be a hand-frames header");
  HandRecording recording;
  {
    const std::string where = fmt::format("{}, line {}", name, line);
    const json document = parse_json(first, where);
    const JsonNode header(document, where, "the header");
    check_header(JsonNode(document, where));
    if (header.has("source")) recording.description = header.at("source", "").text();
  }

  double start = 0.0;
  for (std::string_view content = next_line(text, line); !content.empty();
       content = next_line(text, line)) {
    const std::string where = fmt::format("{}, line {}", name, line);
    const json document = parse_json(content, where);
    const JsonNode node(document, where, "the frame");
    const double time = node.at("t", "the time in seconds").number(-1e12, 1e12);
    if (recording.frames.empty()) start = time;
    if (time - start > kMaxRecordingTime)
      node.fail("is more than a day after the first one; t must be in seconds");
    const JsonNode hands = hands_of(node);
    HandFrame frame;
    for (std::size_t h = 0; h < hands.array_size(); ++h)
      frame.hands.push_back(neutral_hand(hands.at(h)));
    append_frame(node, time - start, frame, recording);
    if (progress) progress(all - text.size(), all);
  }
  require_frames(recording, name);
  return recording;
}

HandRecording read_hand_recording(const std::string& path, const ReadProgress& progress) {
  const std::string text = read_file(path, kMaxRecordingBytes);
  if (const std::string_view kind = kind_by_content(text); kind != "JSON") {
    // people give --hand what --record has written
    const std::string what = kind == "an HDF5 file"
                                 ? "is a recording of prostm (HDF5), not a hand recording"
                                 : is_not(text, "a hand recording");
    refuse_as_hands(path, what);
  }
  // a neutral recording says so in its first line
  const std::string_view first =
      std::string_view(text).substr(0, std::min(text.find('\n', text.find('{')), text.size()));
  return first.find("\"hand-frames\"") != first.npos ? hands_from_jsonl(text, path, progress)
                                                     : hands_from_leap_json(text, path);
}

}  // namespace prostm
