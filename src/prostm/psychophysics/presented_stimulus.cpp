#include "prostm/psychophysics/presented_stimulus.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/units.hpp"
#include "prostm/psychophysics/detail/json_name.hpp"

namespace prostm {
namespace {

constexpr double kReach = 0.2;  // largest coordinate [m]

double milli(const JsonNode& node, const char* key, double low, double high) {
  return from_milli(node.at(key, "a length in mm").number(1e3 * low, 1e3 * high));
}

double number_or(const JsonNode& node, const char* key, double low, double high, double missing) {
  return node.has(key) ? node.at(key, "a number").number(low, high) : missing;
}

std::vector<Vec2> points_from_json(const JsonNode& node) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < node.array_size(); ++i)
    out.push_back(node.at(i).vec2(-1e3 * kReach, 1e3 * kReach) / 1e3);
  return out;
}

Outline outline_from_json(const JsonNode& node) {
  return named_value<Outline>(node.at("outline", "the name of an outline"));
}

AmPoints am_from_json(const JsonNode& node) {
  node.allow_only({"kind", "points_mm", "frequencies_hz"});
  AmPoints out;
  out.points = points_from_json(node.at("points_mm", "a list of points"));
  const JsonNode list = node.at("frequencies_hz", "a list of frequencies");
  for (std::size_t i = 0; i < list.array_size(); ++i)
    out.frequencies.push_back(list.at(i).number(1.0, 1000.0));
  if (out.frequencies.size() != 1 && out.frequencies.size() != out.points.size())
    list.fail("must have one frequency, or one for each point");
  return out;
}

StmLoop stm_from_json(const JsonNode& node) {
  node.allow_only({"kind", "outline", "size_mm", "rate_hz", "speed_m_s", "foci"});
  StmLoop out;
  out.outline = outline_from_json(node);
  out.size = milli(node, "size_mm", 1e-3, kReach);
  if (node.has("rate_hz") == node.has("speed_m_s"))
    node.fail("must have rate_hz or speed_m_s, and not both");
  if (node.has("rate_hz")) {
    out.rate = node.at("rate_hz", "a rate").number(4.0, 1000.0);
  } else {
    const std::vector<Vec2> way = corners(out.outline, out.size);
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) length += (way[i + 1] - way[i]).norm();
    if (out.outline == Outline::Circle) length = kPi * out.size;
    out.rate = node.at("speed_m_s", "a speed").number(0.1, 100.0) / length;
  }
  out.foci = node.has("foci") ? node.at("foci", "a number of foci").integer(1, 8) : 1;
  return out;
}

Disk disk_from_json(const JsonNode& node) {
  node.allow_only({"kind", "area_cm2", "force_mn", "frequency_hz", "pulse_ms"});
  if (node.has("frequency_hz") == node.has("pulse_ms"))
    node.fail("must have frequency_hz or pulse_ms, and not both");
  return {.area = 1e-4 * node.at("area_cm2", "an area").number(0.01, 50.0),
          .force = 1e-3 * node.at("force_mn", "a force").number(1e-3, 1e3),
          .frequency = number_or(node, "frequency_hz", 4.0, 1000.0, 0.0),
          .pulse = 1e-3 * number_or(node, "pulse_ms", 1.0, 200.0, 0.0)};
}

/// Returns points on an arc of the length of a hand's width, of this radius, from −x to +x.
std::vector<Vec2> arc(double length, double radius, int points) {
  std::vector<Vec2> out;
  for (int i = 0; i < points; ++i) {
    const double s = length * (static_cast<double>(i) / (points - 1) - 0.5);
    out.emplace_back(radius * std::sin(s / radius), radius * (1.0 - std::cos(s / radius)));
  }
  return out;
}

SlowPath course_from_json(const JsonNode& node) {
  node.allow_only({"kind", "outline", "size_mm", "arc_mm", "radius_mm", "points", "lap_s",
                   "pause_s", "moments", "frequency_hz", "section_mm", "speed_m_s"});
  SlowPath out;
  if (node.has("arc_mm")) {
    const int points = node.at("points", "a number of points").integer(3, 1000);
    out.way = arc(milli(node, "arc_mm", 1e-3, kReach), milli(node, "radius_mm", 5e-3, 1e3), points);
  } else {
    out.way = corners(outline_from_json(node), milli(node, "size_mm", 1e-3, kReach));
  }
  out.lap = node.at("lap_s", "a time").number(0.01, 60.0);
  out.pause = number_or(node, "pause_s", 0.0, 60.0, 0.0);
  if (node.has("moments")) out.moments = node.at("moments", "a number").integer(1, 200);
  out.frequency = number_or(node, "frequency_hz", 4.0, 1000.0, 0.0);
  if (out.frequency == 0.0) {
    out.section = milli(node, "section_mm", 1e-3, kReach);
    out.speed = node.at("speed_m_s", "a speed").number(0.1, 100.0);
  }
  return out;
}

Sweep sweep_from_json(const JsonNode& node) {
  node.allow_only({"kind", "length_mm", "speed_m_s", "zigzag_mm", "rate_hz"});
  return {.length = milli(node, "length_mm", 1e-3, kReach),
          .speed = node.at("speed_m_s", "a speed").number(0.45, 100.0),
          .zigzag = milli(node, "zigzag_mm", 0.0, kReach),
          .rate = node.at("rate_hz", "a rate").number(1.0, 500.0)};
}

}  // namespace

std::vector<Vec2> corners(Outline outline, double size) {
  if (outline == Outline::Line) return {Vec2(-0.5 * size, 0.0), Vec2(0.5 * size, 0.0)};
  constexpr std::array kSides = {2, 96, 3, 4, 6, 8};
  const int sides = kSides[static_cast<std::size_t>(outline)];
  const double radius =
      outline == Outline::Circle ? 0.5 * size : 0.5 * size / std::sin(kPi / sides);
  std::vector<Vec2> out;
  // a corner above the centre, or a side, so that polygons stand upright
  const double first = 0.5 * kPi + (sides % 2 == 0 ? kPi / sides : 0.0);
  for (int i = 0; i <= sides; ++i) {
    const double angle = first + 2.0 * kPi * (i % sides) / sides;
    out.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return out;
}

PresentedStimulus stimulus_from_json(const JsonNode& node) {
  const JsonNode kind = node.at("kind", "am, stm, disk, course or sweep");
  const std::string name = kind.text();
  if (name == "am") return am_from_json(node);
  if (name == "stm") return stm_from_json(node);
  if (name == "disk") return disk_from_json(node);
  if (name == "course") return course_from_json(node);
  if (name == "sweep") return sweep_from_json(node);
  kind.fail("must be am, stm, disk, course or sweep");
}

}  // namespace prostm
