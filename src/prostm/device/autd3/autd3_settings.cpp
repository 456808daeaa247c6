// Settings of AUTD3 units, the file of their poses, and the search for them.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/device/autd3/autd3_array.hpp"
#include "prostm/device/autd3/detail/autd3_session.hpp"

namespace prostm {
namespace {

constexpr double kFarthest = 2e3;    // of a unit from the origin of D, along each axis [mm]
constexpr double kTolerance = 1e-3;  // of a quaternion's length
constexpr std::chrono::milliseconds kLook{400};

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({.name = "units",
           .help = "file with the poses of AUTD3 units; empty: one unit, its middle at the origin",
           .names_file = true},
          s.units);
  v.field({"block_time", "s", 0, 0.025,
           "duration of a block of the stream to AUTD3; 0: as short as the link allows"},
          s.block_time);
  v.field({.name = "weights",
           .help = "whether each focal point has its own intensity, which allows at most four"},
          s.weights);
}

}  // namespace

void Autd3Settings::visit(SettingsReader& v) const {
  list(*this, v);
}
void Autd3Settings::visit(SettingsWriter& v) {
  list(*this, v);
}

std::vector<Pose> autd3_units_from_json(std::string_view text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  require_format(root, "prostm-autd3/1");
  root.allow_only({"format", "units"});
  const JsonNode units = root.at("units", "the poses of the units, [{…}, …]");
  const std::size_t count = units.array_size();
  if (count < 1 || count > autd3::kMostUnits)
    units.fail(fmt::format("has {} units; it must have 1 to {}", count, autd3::kMostUnits));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonNode unit = units.at(i);
    unit.allow_only({"position_mm", "quaternion"});
    Pose X_DM = Pose::Identity();
    X_DM.translation() =
        from_milli(unit.at("position_mm", "the position of the unit's middle, [x, y, z]")
                       .vec3(-kFarthest, kFarthest));
    if (unit.has("quaternion")) {
      const JsonNode turn = unit.at("quaternion", "the unit's orientation, [x, y, z, w]");
      if (turn.array_size() != 4)
        turn.fail(fmt::format("has {} numbers; it must have 4: x, y, z, w", turn.array_size()));
      const auto part = [&](std::size_t k) { return turn.at(k).number(-2.0, 2.0); };
      const Quat q(part(3), part(0), part(1), part(2));
      if (std::abs(q.norm() - 1.0) > kTolerance)
        turn.fail(fmt::format("has the length {:.6g}; it must be 1 within 0.001", q.norm()));
      X_DM.linear() = q.normalized().toRotationMatrix();
    }
    poses.push_back(X_DM * autd3_middle());
  }
  return poses;
}

DeviceFinding look_for_autd3(const Autd3Setup& setup) {
  const std::vector<Pose> units =
      setup.units.empty() ? std::vector<Pose>{autd3_middle()} : setup.units;
  autd3::Session session(setup.address, units);
  if (!session.open(kLook)) return {false, session.problem()};
  DeviceFinding finding{
      true, fmt::format("autd3://{} drives {} unit{}, {}", setup.address.text(), units.size(),
                        units.size() == 1 ? "" : "s", session.firmware())};
  session.close();
  return finding;
}

std::vector<Pose> Autd3Settings::poses() const {
  if (units.empty()) return {};
  return autd3_units_from_json(read_file(units, kMaxJsonBytes), units);
}

}  // namespace prostm
