#include "prostm/io/digitised_figure.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/text/json.hpp"
#include "prostm/io/detail/raster_json.hpp"

namespace prostm {
namespace {

std::vector<Vec2> read_points(const JsonNode& node) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < node.array_size(); ++i) {
    points.push_back(1e-3 * node.at(i).vec2(-kMaxCoordinateMm, kMaxCoordinateMm));
  }
  return points;
}

/// Reads a closed line, whose first point is repeated at the end.
std::vector<Vec2> read_loop(const JsonNode& node) {
  std::vector<Vec2> points = read_points(node);
  if (points.size() < 2 || points.front() != points.back()) {
    node.fail("must be a closed line of at least two points, the first repeated at the end");
  }
  points.pop_back();
  return points;
}

/// A tour as clusters: each point is replaced by the nearest cluster.
std::vector<int> as_tour(const std::vector<Vec2>& loop, const std::vector<Vec2>& clusters) {
  std::vector<int> tour;
  for (const Vec2& x : loop) {
    const auto nearest =
        std::min_element(clusters.begin(), clusters.end(), [&](const Vec2& a, const Vec2& b) {
          return (a - x).squaredNorm() < (b - x).squaredNorm();
        });
    tour.push_back(static_cast<int>(nearest - clusters.begin()));
  }
  return tour;
}

/// The target at the nearest cell; 0 outside the raster.
double pressure_near(const TargetField& target, const Vec2& x) {
  const Vec2 q = (x - target.origin) / target.cell;
  const int col = static_cast<int>(std::lround(q.x())), row = static_cast<int>(std::lround(q.y()));
  if (row < 0 || col < 0 || row >= target.rows || col >= target.cols) return 0.0;
  return target.pressure[target.index(row, col)];
}

FocalPath as_path(const std::vector<Vec2>& loop, const TargetField& target, const GainLaw& gain,
                  double speed) {
  FocalPath path;
  path.points.assign(loop.begin(), loop.end());
  path.length = closed_length(path);
  path.speed = speed;
  path.period = path.length / speed;
  for (const Vec2& x : loop) {
    path.pressure.push_back(gain.of(path.period) * pressure_near(target, x));
  }
  return path;
}

}  // namespace

DigitisedFigure digitised_figure_from_json(std::string_view text, const std::string& name,
                                           const TargetField& target, const GainLaw& gain,
                                           double speed) {
  const nlohmann::json document = parse_json(text, name);
  const JsonNode figure = JsonNode(document, name).at("fig2", "a digitised figure");
  DigitisedFigure out;

  out.trace.clusters = read_points(figure.at("clusters_mm", "an array of points"));
  if (out.trace.clusters.empty()) figure.fail("must have at least one cluster");
  const JsonNode values = figure.at("cluster_value_norm", "an array of numbers");
  if (values.array_size() != out.trace.clusters.size())
    values.fail("must have a number per cluster");
  for (std::size_t i = 0; i < values.array_size(); ++i) {
    out.trace.cluster_mass.push_back(values.at(i).number(0.0, kMaxFilePressure));
  }
  const std::vector<Vec2>& clusters = out.trace.clusters;
  out.trace.tour = as_tour(read_loop(figure.at("initial_tour_mm", "a closed line")), clusters);
  const JsonNode split = figure.at("split_paths_mm", "an array of closed lines");
  for (std::size_t i = 0; i < split.array_size(); ++i) {
    out.trace.split.push_back(as_tour(read_loop(split.at(i)), clusters));
  }

  const JsonNode refined = figure.at("refined_paths_mm", "an array of closed lines");
  if (refined.array_size() > kMaxPaths) refined.fail("must have at most 8 paths");
  for (std::size_t i = 0; i < refined.array_size(); ++i) {
    const std::vector<Vec2> loop = read_loop(refined.at(i));
    if (loop.size() > kMaxPathPoints) refined.at(i).fail("must have at most 64 points");
    out.plan.paths.push_back(as_path(loop, target, gain, speed));
  }

  const JsonNode rendered = figure.at("recon_norm", "a matrix of the target's size");
  check_matrix(rendered, target);
  for (std::size_t row = 0; row < rendered.array_size(); ++row) {
    const JsonNode line = rendered.at(row);
    for (std::size_t col = 0; col < line.array_size(); ++col) {
      const bool skin = !line.at(col).value().is_null();
      out.reconstruction.push_back(skin ? line.at(col).number(0.0, kMaxFilePressure) : 0.0);
    }
  }
  return out;
}

}  // namespace prostm
