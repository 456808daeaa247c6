#include "prostm/io/plan_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/emit/played_plan.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/quantity_json.hpp"
#include "prostm/io/sensation_json.hpp"
#include "prostm/io/settings_file.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

Json path_json(const FocalPath& path) {
  Json points = Json::array(), pressure = Json::array();
  for (const Vec2& x : path.points) points.push_back(milli_json(x));
  for (const double p : path.pressure) pressure.push_back(p);
  return {{"patch", path.patch},
          {"points_mm", std::move(points)},
          {"pressure", std::move(pressure)},
          {"length_mm", to_milli(path.length)},
          {"speed_m_s", path.speed},
          {"period_ms", to_milli(path.period)}};
}

Json focus_json(const FocalPoint& focus) {
  Json json = {{"patch", focus.patch},
               {"position_mm", milli_json(focus.position)},
               {"pressure", focus.pressure}};
  if (focus.phase != 0.0) json["phase"] = focus.phase;
  return json;
}

void write_quality(const PlanQuality& quality, Json& document) {
  document["sigma_mm"] = to_milli(quality.sigma);
  document["full_scale_pressure"] = quality.full_scale_pressure;
  document["metrics"] = quantities_to_json(quality.played);
  document["planned_metrics"] = quantities_to_json(quality.planned);
  if (quality.at.empty()) return;
  Json& list = document["metrics_at"] = Json::array();
  for (const PlanQuality::At& at : quality.at) {
    list.push_back({{"sigma_mm", to_milli(at.sigma)}, {"metrics", quantities_to_json(at.played)}});
  }
}

FocalPath read_path(const JsonNode& node) {
  FocalPath path;
  if (node.has("patch")) path.patch = node.at("patch", "").integer(0, kMaxPatches - 1);
  const JsonNode points = node.at("points_mm", "an array of points [x, y]");
  const JsonNode pressure = node.at("pressure", "an array of pressures");
  const std::size_t count = points.array_size();
  if (count < 1 || count > static_cast<std::size_t>(kMaxPathPoints)) {
    points.fail(fmt::format("has {} points; a path must have from 1 to {}", count, kMaxPathPoints));
  }
  if (pressure.array_size() != count) {
    pressure.fail(fmt::format("has {} numbers; it must have one for each of the {} points",
                              pressure.array_size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 mm = points.at(i).vec2(-kMaxCoordinateMm, kMaxCoordinateMm);
    path.points.push_back(Vec2(from_milli(mm.x()), from_milli(mm.y())));
    path.pressure.push_back(pressure.at(i).number(0.0, kMaxFilePressure));
  }

  // the length follows from the points
  const double length = closed_length(path);
  const JsonNode length_mm = node.at("length_mm", "the length of the closed path");
  path.length = from_milli(length_mm.number(0.0, kMaxCoordinateMm));
  constexpr double kLengthTolerance = 1e-4;
  if (std::abs(path.length - length) > kLengthTolerance) {
    length_mm.fail(fmt::format("is {}; the closed path through the points is {:.3f} mm long",
                               to_milli(path.length), to_milli(length)));
  }
  constexpr double kMinSpeed = 0.001, kMaxSpeed = 1000.0;
  path.speed = node.at("speed_m_s", "the speed of the focal point").number(kMinSpeed, kMaxSpeed);

  // a loop takes length / speed, or longer on uneven skin
  path.period = path.length / path.speed;
  if (node.has("period_ms")) {
    const JsonNode period_ms = node.at("period_ms", "the time of a lap");
    const double period = from_milli(period_ms.number(0.0, kMaxCoordinateMm / kMinSpeed));
    if (period < (path.length - kLengthTolerance) / path.speed) {
      period_ms.fail(fmt::format("is {}; a lap of {:.3f} mm at {} m/s takes at least {:.4f} ms",
                                 to_milli(period), to_milli(path.length), path.speed,
                                 to_milli(path.period)));
    }
    path.period = period;
  }
  return path;
}

FocalPoint read_focus(const JsonNode& node) {
  FocalPoint focus;
  if (node.has("patch")) focus.patch = node.at("patch", "").integer(0, kMaxPatches - 1);
  const Vec2 mm =
      node.at("position_mm", "a point [x, y]").vec2(-kMaxCoordinateMm, kMaxCoordinateMm);
  focus.position = Vec2(from_milli(mm.x()), from_milli(mm.y()));
  focus.pressure = node.at("pressure", "a number").number(0.0, kMaxFilePressure);
  if (node.has("phase")) focus.phase = node.at("phase", "").number(0.0, 1.0);
  return focus;
}

double read_loop(const JsonNode& root) {
  if (!root.has("loop_ms")) return 0.0;
  const JsonNode loop_ms = root.at("loop_ms", "");
  const double loop = from_milli(loop_ms.number(0.0, to_milli(kLongestLoop)));
  if (!is_loop(loop)) {
    loop_ms.fail(fmt::format("is {}; it must be 0 or from {} to {}", to_milli(loop),
                             to_milli(kShortestLoop), to_milli(kLongestLoop)));
  }
  return loop;
}

template <class Read, class List>
void read_list(const JsonNode& node, const char* what, const Read& read, List& out) {
  if (node.array_size() > out.capacity()) {
    node.fail(
        fmt::format("has {} {}; it must have at most {}", node.array_size(), what, out.capacity()));
  }
  for (std::size_t i = 0; i < node.array_size(); ++i) out.push_back(read(node.at(i)));
}

}  // namespace

nlohmann::ordered_json played_to_json(const PlayedPlan& played) {
  Json list = Json::array();
  for (const PlayedPath& path : played.paths) {
    list.push_back({{"speed_m_s", path.speed},
                    {"period_ms", to_milli(path.period)},
                    {"planned_speed_m_s", path.planned_speed},
                    {"planned_period_ms", to_milli(path.planned_period)}});
  }
  return list;
}

std::string plan_to_json(const Plan& plan, const TargetField& target, const PlanFileExtras& extras,
                         const std::vector<SettingsGroup>& settings) {
  Json document = {{"format", "prostm-plan/1"}, {"method", name_of(extras.method)}};
  if (extras.preset) document["preset"] = name_of(*extras.preset);
  if (plan.loop > 0.0) document["loop_ms"] = to_milli(plan.loop);
  Json& list = document[extras.method == Method::Am ? "foci" : "paths"] = Json::array();
  for (const FocalPath& path : plan.paths) list.push_back(path_json(path));
  for (const FocalPoint& focus : plan.foci) list.push_back(focus_json(focus));

  if (extras.played != nullptr) document["played"] = played_to_json(*extras.played);
  if (extras.power != nullptr) {
    document["power"] = {{"share_of_array", extras.power->array},
                         {"share_of_full_scale", extras.power->pressure},
                         {"limit", extras.power->limit}};
  }

  // statistics and quality
  if (extras.stats != nullptr) {
    document.update(quantities_to_json(*extras.stats));
  }
  if (extras.metrics != nullptr) document["metrics"] = quantities_to_json(*extras.metrics);
  if (extras.quality != nullptr) {
    write_quality(*extras.quality, document);
    if (extras.sensation) {
      document["sensation"] =
          sensation_to_json(extras.quality->played.sensation_level, *extras.sensation);
    }
  }
  if (extras.controls != nullptr) {
    document["controls"] = Json::array();
    for (const Control& control : *extras.controls) {
      document["controls"].push_back(
          {{"name", control.name}, {"metrics", quantities_to_json(control.metrics)}});
    }
  }

  if (extras.warnings != nullptr) document["warnings"] = *extras.warnings;

  // plane and heights, needed to lift the paths back onto the skin
  document["plane"] = plane_json(target.X_DP);
  Json raster = Json::object();
  write_raster(target, raster);
  raster["height_mm"] = heights_json(target);
  document["raster"] = std::move(raster);
  if (!settings.empty()) document["settings"] = settings_to_json(settings);
  if (!extras.program.empty()) document["prostm"] = extras.program;
  return to_text(document);
}

PlanFile plan_from_json(std::string_view text, const std::string& name) {
  const nlohmann::json document = parse_json(text, name);
  const JsonNode root(document, name);
  require_format(root, "prostm-plan/1");
  PlanFile file;
  file.method = root.has("foci") ? Method::Am : Method::ProStm;
  if (file.method == Method::Am) {
    if (root.has("paths")) root.fail("has both foci and paths; a plan has one of the two");
    if (root.has("loop_ms")) root.fail("has foci and loop_ms; only paths have a loop");
    read_list(root.at("foci", "an array of foci"), "foci", read_focus, file.plan.foci);
  } else {
    read_list(root.at("paths", "an array of paths, or foci"), "paths", read_path, file.plan.paths);
    file.plan.loop = read_loop(root);
  }

  if (root.has("full_scale_pressure")) {
    file.full_scale_pressure =
        root.at("full_scale_pressure", "a number").number(0.0, kMaxFilePressure);
  }

  if (root.has("sigma_mm"))
    file.sigma = from_milli(root.at("sigma_mm", "a number").number(0.0, kMaxCoordinateMm));

  // the raster has skin where it has a height
  const JsonNode raster = root.at("raster", "the raster with the heights of the skin");
  read_raster(raster, file.raster);
  const JsonNode heights = raster.at("height_mm", "an array of rows of heights in mm");
  check_matrix(heights, file.raster);
  for (int row = 0; row < file.raster.rows; ++row) {
    const auto& line = heights.value()[static_cast<std::size_t>(row)];
    for (int col = 0; col < file.raster.cols; ++col) {
      file.raster.skin[file.raster.index(row, col)] =
          line[static_cast<std::size_t>(col)].is_null() ? 0 : 1;
    }
  }
  read_heights(heights, file.raster);
  file.raster.X_DP = read_plane(root.at("plane", "the plane's origin_mm, x and y"));
  return file;
}

}  // namespace prostm
