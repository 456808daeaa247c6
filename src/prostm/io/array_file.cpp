#include "prostm/io/array_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

constexpr Directivity kKinds[] = {Directivity::Piston, Directivity::T4010A1, Directivity::Omni};

Directivity read_directivity(const JsonNode& node) {
  const std::string name = node.text();
  for (const Directivity kind : kKinds) {
    if (name == directivity_name(kind)) return kind;
  }
  node.fail(R"(is not a directivity; it must be "piston", "t4010a1" or "omni")");
}

void read_amplitude(const JsonNode& root, TransducerArray& array) {
  constexpr double kLeast = 1e-6, kMost = 1e3;
  const JsonNode amplitude =
      root.at("amplitude_pa_m", "the rms pressure at full drive on axis × distance in Pa·m");
  array.amplitude = array.amplitude_low = array.amplitude_high = amplitude.number(kLeast, kMost);
  if (root.has("measured_amplitude_pa_m")) {
    array.measured_amplitude = root.at("measured_amplitude_pa_m", "").number(kLeast, kMost);
  }
  if (!root.has("amplitude_interval_pa_m")) return;
  const JsonNode interval = root.at("amplitude_interval_pa_m", "");
  const Vec2 bounds = interval.vec2(kLeast, kMost);
  if (bounds.x() > array.amplitude || bounds.y() < array.amplitude) {
    interval.fail(
        fmt::format("is [{}, {}]; it must be [low, high] with \"amplitude_pa_m\" = {} "
                    "in it",
                    bounds.x(), bounds.y(), array.amplitude));
  }
  array.amplitude_low = bounds.x();
  array.amplitude_high = bounds.y();
}

void read_positions(const JsonNode& node, TransducerArray& array) {
  const std::size_t count = node.array_size();
  if (count < 1 || count > static_cast<std::size_t>(kMaxTransducers)) {
    node.fail(
        fmt::format("has {} transducers; an array must have from 1 to {}", count, kMaxTransducers));
  }
  constexpr double kFarthestMm = 10e3;
  array.position.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    array.position.push_back(from_milli(node.at(i).vec3(-kFarthestMm, kFarthestMm)));
  }
}

void read_normals(const JsonNode& node, TransducerArray& array) {
  if (node.array_size() != array.position.size()) {
    node.fail(fmt::format("has {} normals; it must have one for each of the {} transducers",
                          node.array_size(), array.position.size()));
  }
  constexpr double kTolerance = 1e-3;
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    const Vec3 n = node.at(i).vec3(-1.0 - kTolerance, 1.0 + kTolerance);
    if (std::abs(n.norm() - 1.0) > kTolerance) {
      node.at(i).fail(fmt::format("has the length {:.6g}; it must be a unit vector", n.norm()));
    }
    array.normal[i] = n.normalized();
  }
}

}  // namespace

std::string array_to_json(const TransducerArray& array) {
  Json positions = Json::array(), normals = Json::array();
  bool all_face_z = true;
  for (const Vec3& p : array.position) positions.push_back(milli_json(p));
  for (const Vec3& n : array.normal) {
    normals.push_back({n.x(), n.y(), n.z()});
    all_face_z = all_face_z && n == Vec3::UnitZ();
  }
  Json document = {{"format", "prostm-array/1"},
                   {"name", array.name},
                   {"frequency_hz", array.frequency},
                   {"radius_mm", to_milli(array.radius)},
                   {"directivity", directivity_name(array.directivity)},
                   {"amplitude_pa_m", array.amplitude}};
  document["amplitude_interval_pa_m"] = {array.amplitude_low, array.amplitude_high};
  if (array.measured_amplitude > 0.0) {
    document["measured_amplitude_pa_m"] = array.measured_amplitude;
  }
  document["transducers_mm"] = std::move(positions);
  if (!all_face_z) document["normals"] = std::move(normals);
  return to_text(document);
}

TransducerArray array_from_json(std::string_view text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  require_format(root, "prostm-array/1");
  root.allow_only({"format", "name", "frequency_hz", "radius_mm", "directivity", "amplitude_pa_m",
                   "amplitude_interval_pa_m", "measured_amplitude_pa_m", "transducers_mm",
                   "normals"});
  TransducerArray array;
  array.name = root.at("name", "the name of the array").text();
  array.frequency = root.at("frequency_hz", "the carrier's frequency in Hz").number(20e3, 100e3);
  array.radius = from_milli(root.at("radius_mm", "a transducer's radius in mm").number(0.1, 50.0));
  array.directivity = read_directivity(root.at("directivity", R"("piston", "t4010a1" or "omni")"));
  read_amplitude(root, array);
  read_positions(root.at("transducers_mm", "an array of positions [x, y, z]"), array);
  array.normal.assign(array.position.size(), Vec3::UnitZ());
  if (root.has("normals")) read_normals(root.at("normals", ""), array);

  // checks that involve several values
  try {
    validate(array);
  } catch (const std::invalid_argument& e) {
    throw InputError(fmt::format("{}: {}", file, e.what()));
  }
  return array;
}

TransducerArray array_from_name(const std::string& name, std::span<const ArrayKind> kinds) {
  std::vector<std::string> names;
  for (const ArrayKind& kind : kinds) {
    if (name == kind.name) return kind.make();
    names.emplace_back(kind.name);
  }
  if (name.ends_with(".json")) return read_array(name);
  throw InputError(fmt::format("array {} is unknown; it must be {}{}", name,
                               array_choices({}, kinds), did_you_mean(name, names)));
}

std::string array_choices(const std::string& of_default, std::span<const ArrayKind> kinds) {
  std::vector<std::string> entries;
  for (const ArrayKind& kind : kinds)
    entries.push_back(kind.name + (entries.empty() ? of_default : ""));
  entries.emplace_back("an array file (.json)");
  return listed(entries);
}

TransducerArray read_array(const std::string& path) {
  return array_from_json(read_file(path, kMaxJsonBytes), path);
}

}  // namespace prostm
