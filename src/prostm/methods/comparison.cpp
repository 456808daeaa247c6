#include "prostm/methods/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "prostm/core/input_error.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::methods {
namespace {

constexpr int kCells = 54;  // per edge of the raster; each of 3 mm

}  // namespace

void Means::add(const Rendering& r, const Rendering& reference) {
  rmse.add(r.of_model.rmse);
  correlation.add(r.of_model.correlation);
  model_skill.add(r.of_model.skill_0);
  model_overlap.add(r.of_model.overlap);
  model_spill.add(r.of_model.spill);
  skill_0.add(r.of_envelope.skill_0);
  skill_8.add(r.of_envelope.skill_8);
  overlap.add(r.of_envelope.overlap);
  spill.add(r.of_envelope.spill);
  felt_skill_8.add(r.of_felt.skill_8);
  lack.add(1.0 - r.of_envelope.skill_8);
  felt_lack.add(1.0 - r.of_felt.skill_8);
  felt_correlation.add(r.of_felt.correlation);
  felt_overlap.add(r.of_felt.overlap);
  felt_spill.add(r.of_felt.spill);
  side_lobe.add(r.field.side_lobe);
  ghosts.add(r.ghosts.count);
  ghost.add(r.ghosts.largest);
  for (const Equal equal : {Equal::Drive, Equal::Power, Equal::Percept}) {
    const double factor = factor_for(equal, r, reference);
    Level& out = level[static_cast<std::size_t>(equal)];
    if (factor == 0.0) continue;
    out.pressure.add(factor * r.field.largest);
    out.lobe.add(factor * r.field.side_lobe * r.field.largest);
    out.percept.add(1e6 * factor * r.felt.largest);
    out.intensity.add(1e6 * factor * r.felt.intensity);
    out.ghost.add(1e6 * factor * r.ghosts.largest * r.felt.largest);
  }
}

std::vector<Rendering> render_ways(Renderer& renderer, const TargetField& target) {
  std::vector<Rendering> all;
  for (const Way way : kWays) {
    all.push_back(renderer.render(way, target));
    if (!all.back().felt_at_all) return {};
  }
  return all;
}

void add_ways(const std::vector<Rendering>& renderings, std::array<Means, kWays.size()>& means) {
  const auto best = static_cast<std::size_t>(std::ranges::find(kWays, Way::Best) - kWays.begin());
  for (std::size_t w = 0; w < kWays.size(); ++w) means[w].add(renderings[w], renderings[best]);
}

double factor_for(Equal equal, const Rendering& rendering, const Rendering& reference) {
  if (equal == Equal::Percept) return reference.felt.largest / rendering.felt.largest;
  if (rendering.mean_power == 0.0) return 0.0;
  return equal == Equal::Drive ? 1.0 : reference.mean_power / rendering.mean_power;
}

Targets generated_targets(int frames) {
  Targets targets;
  for (const fields::Pattern pattern : fields::kPatterns) {
    for (int i = 0; i < frames; ++i)
      targets.push_back(
          fields::make(pattern, (2 * i + 1) * fields::kFrames / (2 * frames), kCells));
  }
  return targets;
}

Targets recorded_targets(const std::string& path, int frames) {
  const RecordingReader recording(path);
  Targets targets;
  for (int i = 0; i < frames; ++i) {
    const int half = recording.frames() / 2;
    const int frame = half + (2 * i + 1) * (recording.frames() - half) / (2 * frames);
    const TargetFrame read = recording.frame(frame);
    if (read.patches.empty() || max_pressure(read.patches[0]) == 0.0)
      throw InputError(fmt::format("{}, frame {}: no pressure on a hand", path, frame));
    targets.push_back(read.patches[0]);
    const TargetField &first = targets.front(), &last = targets.back();
    if (last.rows != first.rows || last.cols != first.cols)
      throw InputError(fmt::format(
          "{}, frame {}: the size of the raster changed, because the hand moved", path, frame));
  }
  return targets;
}

void draw_ways(const std::string& path) {
  constexpr std::array kDrawn = {fields::Pattern::OnePlume, fields::Pattern::FourPlumes};
  constexpr std::array kShown = {Way::PaperValid, Way::BestNarrow, Way::Felt,
                                 Way::Am,         Way::AmFelt,     Way::Circle};
  constexpr int kFrame = 50;
  Renderer renderer(usx_array(), fields::make(kDrawn[0], kFrame, kCells));
  MapFigure figure;
  figure.title = "Largest pressure of an array on the skin during the loop, and the percept";
  figure.scale = "relative to the largest";
  figure.columns = static_cast<int>(kShown.size()) + 1;  // with the target
  for (const fields::Pattern pattern : kDrawn) {
    const TargetField target = fields::make(pattern, kFrame, kCells);
    const auto map = [&](const std::string& title, const std::vector<double>& values,
                         const Metrics& m) {
      return FieldMap{
          title,       fmt::format("S_8.5 {:.2f}, overlap {:.2f}", m.skill_8, m.overlap),
          target.rows, target.cols,
          target.cell, values};
    };
    figure.maps.push_back({fields::to_string(pattern) + ", target", "", target.rows, target.cols,
                           target.cell, target.pressure});
    std::vector<FieldMap> felt = {figure.maps.back()};
    for (const Way way : kShown) {
      const Rendering r = renderer.render(way, target);
      figure.maps.push_back(map(to_string(way) + ", pressure", r.field.envelope, r.of_envelope));
      felt.push_back(map(to_string(way) + ", percept", r.felt.percept, r.of_felt));
    }
    figure.maps.insert(figure.maps.end(), felt.begin(), felt.end());
  }
  draw_maps(figure, path);
}

}  // namespace prostm::methods
