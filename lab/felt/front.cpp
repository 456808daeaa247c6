#include "felt/front.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace prostm::bench {
namespace {

struct FrontPoint {
  double strength = 1.0, lack = 1.0;
  std::string label;
};
/// Ways of one kind.
struct FrontLine {
  std::string name;
  std::vector<FrontPoint> points;
};

/// Splits the name of a way into that of its line, and the label of its point, which is short.
std::pair<std::string, std::string> parts_of(const std::string& way) {
  const std::size_t comma = way.rfind(", ");
  if (comma == std::string::npos) return {way, ""};
  const std::size_t label = comma + 2;
  return {way.substr(0, comma), way.substr(label, way.find(' ', label) - label)};
}

/// Returns the lines of a set, in the order of their first ways, each by strength.
std::vector<FrontLine> lines_of(const JudgedSet& set) {
  std::vector<FrontLine> lines;
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    const auto [name, label] = parts_of(set.ways[w]);
    auto line = std::ranges::find(lines, name, &FrontLine::name);
    if (line == lines.end()) line = lines.insert(line, {name, {}});
    line->points.push_back({compare_strength(set, w).ratio, compare_shape(set, w).lack, label});
  }
  for (FrontLine& line : lines) std::ranges::sort(line.points, {}, &FrontPoint::strength);
  return lines;
}

}  // namespace

std::vector<Chart> front_charts(const std::vector<JudgedSet>& sets) {
  std::vector<Chart> charts;
  for (const JudgedSet& set : sets) {
    Chart& chart = charts.emplace_back();
    chart.title = fmt::format("{}, {} fields", set.name, set.fields.size());
    chart.x_label = fmt::format("strength / that of {}", set.ways[0]);
    chart.y_label = fmt::format("lack of felt shape / that of {}", set.ways[0]);
    chart.logarithmic_x = chart.logarithmic_y = false;
    for (const FrontLine& line : lines_of(set)) {
      ChartSeries& series = chart.series.emplace_back();
      series.name = line.name;
      for (const FrontPoint& point : line.points) {
        series.x.push_back(point.strength);
        series.y.push_back(point.lack);
        series.labels.push_back(point.label);
      }
    }
  }
  return charts;
}

}  // namespace prostm::bench
