#include "prostm/io/hand/hand_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/detail/hand_collector.hpp"
#include "prostm/io/hand/detail/hand_lines.hpp"
#include "prostm/track/hand_json.hpp"

namespace prostm {
namespace {

using nlohmann::json;

constexpr double kMaxHandDistance = 10.0;  // beyond the range of any tracker [m]
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
    fail_as(HandFault::Axes, node,
            fmt::format("has a quaternion of length {} at joint {}; it must be 1 within 0.01", norm,
                        joint_name(static_cast<int>(joint))));
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

constexpr double kMostLength = 1e6;  // largest length that may be a hand in some unit
constexpr HandUnits kUnits = {"t", 1.0, "seconds", 1.0, "metres"};

double time_of(const JsonNode& frame) {
  try {
    return frame.at("t", "the time in seconds").number(-1e12, 1e19);
  } catch (const InputError& error) {
    throw HandError(HandFault::Time, error.what());
  }
}

/// Records the size of the frame's hands as written, whether or not they are valid.
void note_spans(const JsonNode& hands, HandCollector& collector) {
  const auto number = [](const json& list, std::size_t i) {
    const double x = list[i].is_number() ? list[i].get<double>() : std::nan("");
    return std::isless(std::abs(x), kMostLength) ? x : std::nan("");
  };
  for (const json& hand : hands.value()) {
    const auto p = hand.is_object() ? hand.find("p") : hand.end();
    if (!hand.is_object() || p == hand.end() || !p->is_array() || p->size() != 3 * kJointCount)
      continue;
    const auto joint = [&](std::size_t j) {
      return Vec3(number(*p, 3 * j), number(*p, 3 * j + 1), number(*p, 3 * j + 2));
    };
    collector.note_span((joint(kIndexProximal) - joint(kLittleProximal)).norm());
  }
}

HandFrame neutral_frame(std::string_view line, const std::string& where, const HandFrame* before,
                        HandFaults& faults, HandCollector& collector) {
  const json document = parse_json(line, where);
  const JsonNode node(document, where, "the frame");
  HandFrame frame;
  const JsonNode hands = hands_of(node);
  frame.time = time_of(node);
  note_spans(hands, collector);
  read_hands(hands, neutral_hand, before, faults, frame);
  return frame;
}

/// Refuses a recording compressed by LeapJS Playback.
[[noreturn]] void refuse_packed(const std::string& path) {
  throw InputError(fmt::format(
      "{0} is compressed by lz-string; decompress it: npm install lz-string; node -e 'const fs = "
      "require(\"fs\"); fs.writeFileSync(\"{1}\", require(\"lz-string\").decompressFromBase64("
      "fs.readFileSync(\"{0}\", \"utf8\")))'",
      path, path.substr(0, path.size() - 3)));
}

}  // namespace

HandRecording hands_from_jsonl(std::string_view text, const std::string& name,
                               const ReadProgress& progress) {
  const std::size_t all = text.size();
  std::size_t line = 0;
  const std::string_view first = next_line(text, line);
  if (first.empty())
    throw InputError(name + ": is empty; the first line must be a hand-frames header");
  std::string description;
  {
    const std::string where = fmt::format("{}, line {}", name, line);
    const json document = parse_json(first, where);
    const JsonNode header(document, where, "the header");
    check_header(JsonNode(document, where));
    if (header.has("source")) description = header.at("source", "").text();
  }
  HandCollector collector(name, kUnits);
  for (std::string_view content = next_line(text, line); !content.empty();
       content = next_line(text, line)) {
    const std::string where = fmt::format("{}, line {}", name, line);
    collector.add(fmt::format("line {}", line), [&](const HandFrame* before, HandFaults& faults) {
      return neutral_frame(content, where, before, faults, collector);
    });
    if (progress) progress(all - text.size(), all);
  }
  HandRecording recording = collector.finish();
  recording.description = description;
  return recording;
}

HandRecording read_hand_recording(const std::string& path, const ReadProgress& progress) {
  const std::string text = read_file(path, kMaxRecordingBytes);
  if (!is_json_or_lines(text)) {
    if (path.ends_with(".lz")) refuse_packed(path);
    // a common mistake: --hand given a file written by --record
    const std::string what = kind_by_content(text) == "an HDF5 file"
                                 ? "is a recording of prostm (HDF5), not a hand recording"
                                 : is_not(text, "a hand recording");
    refuse_as_hands(path, what);
  }
  // a neutral recording is identified by its first line
  const std::string_view first =
      std::string_view(text).substr(0, std::min(text.find('\n', text.find('{')), text.size()));
  return first.find("\"hand-frames\"") != first.npos ? hands_from_jsonl(text, path, progress)
                                                     : hands_from_leap_json(text, path, progress);
}

}  // namespace prostm
