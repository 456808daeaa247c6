#include "prostm/io/foci_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFarthestMm = 10e3, kMostPressure = 1e6;

}  // namespace

FociFile foci_from_json(std::string_view text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  require_format(root, "prostm-foci/1");
  root.allow_only({"format", "foci"});
  const JsonNode foci = root.at("foci", "an array of focal points");
  const std::size_t count = foci.array_size();
  if (count < 1 || count > static_cast<std::size_t>(kMaxTransducers)) {
    foci.fail(
        fmt::format("has {} focal points; there must be from 1 to {}", count, kMaxTransducers));
  }
  FociFile out;
  for (std::size_t m = 0; m < count; ++m) {
    const JsonNode focus = foci.at(m);
    focus.allow_only({"position_mm", "pressure_pa"});
    const Vec3 mm = focus.at("position_mm", "a position [x, y, z] in mm, z upwards from the array")
                        .vec3(-kFarthestMm, kFarthestMm);
    out.position.push_back(from_milli(mm));
    out.pressure.push_back(
        focus.at("pressure_pa", "the rms acoustic pressure in Pa").number(0.0, kMostPressure));
  }
  return out;
}

std::string drives_to_json(const TransducerArray& array, const Medium& medium, const FociFile& foci,
                           const FocusSolution& solution) {
  Json drives = Json::array(), reached = Json::array(), positions = Json::array(),
       normals = Json::array(), wanted = Json::array();
  for (const auto& q : solution.drive) drives.push_back({std::abs(q), std::arg(q)});
  for (const auto& p : solution.pressure) reached.push_back(std::abs(p));
  for (const Vec3& p : array.position) positions.push_back(milli_json(p));
  for (const Vec3& n : array.normal) normals.push_back({n.x(), n.y(), n.z()});
  for (std::size_t m = 0; m < foci.position.size(); ++m) {
    wanted.push_back(
        {{"position_mm", milli_json(foci.position[m])}, {"pressure_pa", foci.pressure[m]}});
  }
  const Json document = {{"format", "prostm-drives/1"},
                         {"array", array.name},
                         {"foci", wanted},
                         {"reached_pa", reached},
                         {"level", solution.level},
                         {"drives", drives},
                         {"transducers_mm", positions},
                         {"normals", normals},
                         {"wavelength_mm", to_milli(2.0 * kPi / wave_number(array, medium))},
                         {"amplitude_pa_m", array.amplitude},
                         {"amplitude_interval_pa_m", {array.amplitude_low, array.amplitude_high}},
                         {"radius_mm", to_milli(array.radius)},
                         {"absorption_np_m", medium.absorption(array.frequency)},
                         {"directivity", directivity_name(array.directivity)}};
  return to_text(document);
}

FociFile read_foci(const std::string& path) {
  return foci_from_json(read_file(path, kMaxJsonBytes), path);
}

}  // namespace prostm
