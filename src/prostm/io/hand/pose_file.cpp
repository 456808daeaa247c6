#include "prostm/io/hand/pose_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {
namespace {

constexpr double kFarthest = 5e3;     // of a tracker from the array, along each axis [mm]
constexpr double kMaxResidual = 1e3;  // [mm]
constexpr double kTolerance = 1e-3;   // tolerance of a quaternion's length

}  // namespace

std::string pose_to_json(const Calibration& calibration) {
  const Quat q(calibration.X_DT.linear());
  return to_text({{"format", "prostm-pose/1"},
                  {"position_mm", milli_json(Vec3(calibration.X_DT.translation()))},
                  {"quaternion", {q.x(), q.y(), q.z(), q.w()}},
                  {"rms_mm", to_milli(calibration.rms)},
                  {"largest_mm", to_milli(calibration.largest)}});
}

Calibration pose_from_json(std::string_view text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  require_format(root, "prostm-pose/1");
  root.allow_only({"format", "position_mm", "quaternion", "rms_mm", "largest_mm"});
  Calibration calibration;
  calibration.X_DT.translation() = from_milli(
      root.at("position_mm", "the position of the tracker, [x, y, z]").vec3(-kFarthest, kFarthest));
  const JsonNode turn = root.at("quaternion", "the orientation of the tracker, [x, y, z, w]");
  if (turn.array_size() != 4)
    turn.fail(fmt::format("has {} numbers; it must have 4: x, y, z, w", turn.array_size()));
  const auto part = [&](std::size_t i) { return turn.at(i).number(-2.0, 2.0); };
  const Quat q(part(3), part(0), part(1), part(2));
  if (std::abs(q.norm() - 1.0) > kTolerance)
    turn.fail(fmt::format("has the length {:.6g}; it must be 1 within 0.001", q.norm()));
  calibration.X_DT.linear() = q.normalized().toRotationMatrix();
  const auto residual = [&](const char* key) {
    return root.has(key) ? from_milli(root.at(key, "").number(0.0, kMaxResidual)) : 0.0;
  };
  calibration.rms = residual("rms_mm");
  calibration.largest = residual("largest_mm");
  return calibration;
}

Calibration read_pose(const std::string& path) {
  return pose_from_json(read_file(path, kMaxJsonBytes), path);
}

void write_pose(const std::string& path, const Calibration& calibration) {
  write_file(path, pose_to_json(calibration));
}

Pose tracker_pose_from_name(const std::string& name) {
  if (name == "centre") return default_tracker_pose();
  std::vector<std::string> names{"centre"};
  std::string listed = "centre";
  for (const TrackerKit& kit : kTrackerKits) {
    if (name == kit.name) return tracker_kit_pose(kit);
    names.emplace_back(kit.name);
    listed += std::string(", ") + kit.name;
  }
  if (name.ends_with(".json")) return read_pose(name).X_DT;
  throw InputError("tracker " + name + " is unknown; it must be " + listed +
                   " or a pose file (.json)" + did_you_mean(name, names));
}

}  // namespace prostm
