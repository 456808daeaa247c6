#include "felt/picture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prostm/figure/figures.hpp"

namespace prostm::bench {

void draw_felt(const JudgedSet& set, const std::vector<NamedField>& fields,
               const std::string& path) {
  constexpr std::size_t kMost = 6;
  MapFigure figure;
  figure.title = "What is to be felt, and what is felt, on fields of \"" + set.name + "\"";
  figure.scale = "over the largest";
  figure.columns = static_cast<int>(set.ways.size() + 1);
  const std::size_t drawn = std::min(kMost, fields.size());
  for (std::size_t i = 0; i < drawn; ++i) {
    const std::size_t f = (2 * i + 1) * fields.size() / (2 * drawn);
    const TargetField& target = fields[f].field;
    const auto add = [&](const std::string& title, const std::string& note,
                         const std::vector<double>& values) {
      figure.maps.push_back({title, note, target.rows, target.cols, target.cell, values});
    };
    add(fields[f].name, "target", target.pressure);
    for (std::size_t w = 0; w < set.ways.size(); ++w) {
      const Judged& one = set.results[w][f];
      add(set.ways[w],
          fmt::format("S_8.5 {:.2f}, {:.2f} µm", one.felt.skill_8, 1e6 * one.intensity),
          one.percept);
    }
  }
  draw_maps(figure, path);
}

}  // namespace prostm::bench
