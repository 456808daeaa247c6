#include "methods/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "fields/fields.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::bench {
namespace {

constexpr int kCells = 54;  // per edge of the raster; each of 3 mm

double mean(const Distribution& d) {
  return d.summary().mean;
}

void print_model(const std::array<Means, kWays.size()>& means) {
  fmt::print("\nBy Eq. (1), with the paper's width\n{:<16} {:>8} {:>8} {:>8} {:>8}\n", "", "RMSE",
             "corr.", "S_0", "overlap");
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means& m = means[w];
    if (kWays[w] == Way::Flat) continue;
    fmt::print("{:<16} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f}\n", to_string(kWays[w]), mean(m.rmse),
               mean(m.correlation), mean(m.model_skill), mean(m.model_overlap));
  }
}

void print_shapes(const std::array<Means, kWays.size()>& means) {
  fmt::print(
      "\nShapes, independent of the level. Envelope: largest radiation pressure over the loop; "
      "felt: "
      "the\n"
      "map of perceived intensity; lobe: largest of the envelope more than {:.0f} mm from all "
      "paths, "
      "over\nits largest; ghosts: maxima of the percept above half of its largest where nothing "
      "is "
      "to be felt,\nand the strongest of all such maxima over the largest\n"
      "{:<16} {:>8} {:>8} {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} {:>8} {:>8} {:>9}\n",
      1e3 * kBesidePaths, "", "S_0", "S_8.5", "overlap", "spill", "lobe", "felt S8.5", "corr.",
      "overlap", "spill", "ghosts", "strongest");
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means& m = means[w];
    fmt::print(
        "{:<16} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} | {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} "
        "{:>8.2f} {:>9.3f}\n",
        to_string(kWays[w]), mean(m.skill_0), mean(m.skill_8), mean(m.overlap), mean(m.spill),
        mean(m.side_lobe), mean(m.felt_skill_8), mean(m.felt_correlation), mean(m.felt_overlap),
        mean(m.felt_spill), mean(m.ghosts), mean(m.ghost));
  }
}

void print_levels(const std::array<Means, kWays.size()>& means) {
  constexpr std::array kControls = {"equal largest drive, |q| = 1",
                                    "equal mean power, that of best",
                                    "equal largest percept, that of best"};
  for (std::size_t c = 0; c < kControls.size(); ++c) {
    fmt::print("\nLevels, {}\n{:<16} {:>14} {:>12} {:>14} {:>14} {:>14}\n", kControls[c], "",
               "pressure, Pa", "lobe, Pa", "percept, um", "sqrt E, um", "ghost, um");
    for (std::size_t w = 0; w < kWays.size(); ++w) {
      const Means::Level& level = means[w].level[c];
      if (level.pressure.count() == 0) continue;
      fmt::print("{:<16} {:>14.2f} {:>12.2f} {:>14.3f} {:>14.3f} {:>14.3f}\n", to_string(kWays[w]),
                 mean(level.pressure), mean(level.lobe), mean(level.percept), mean(level.intensity),
                 mean(level.ghost));
    }
  }
}

}  // namespace

void Means::add(const Rendering& r, const Rendering& reference) {
  rmse.add(r.of_model.rmse);
  correlation.add(r.of_model.correlation);
  model_skill.add(r.of_model.skill_0);
  model_overlap.add(r.of_model.overlap);
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

bool add_ways(Renderer& renderer, const TargetField& target,
              std::array<Means, kWays.size()>& means) {
  std::vector<Rendering> all;
  for (const Way way : kWays) {
    all.push_back(renderer.render(way, target));
    if (!all.back().felt_at_all) return false;
  }
  const auto best = static_cast<std::size_t>(std::ranges::find(kWays, Way::Best) - kWays.begin());
  for (std::size_t w = 0; w < kWays.size(); ++w) means[w].add(all[w], all[best]);
  return true;
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
          "{}, frame {}: the hand moved, and its raster is of another size", path, frame));
  }
  return targets;
}

void compare_ways(const Targets& targets, std::vector<Row>& rows) {
  Renderer renderer(usx_array(), targets.at(0));
  std::array<Means, kWays.size()> means;
  for (const TargetField& target : targets) {
    if (!add_ways(renderer, target, means))
      throw InputError("a plan's loop is too long for its percept to be computed");
  }
  print_model(means);
  print_shapes(means);
  print_levels(means);
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    if (kWays[w] == Way::Best) continue;
    rows.push_back({"methods/best/1 - S_8.5 of the envelope", "", means[1].lack.summary(),
                    to_string(kWays[w]), means[w].lack.summary().p50});
    rows.push_back({"methods/best/1 - S_8.5 of what is felt", "", means[1].felt_lack.summary(),
                    to_string(kWays[w]), means[w].felt_lack.summary().p50});
  }
}

void draw_ways(const std::string& path) {
  constexpr std::array kDrawn = {fields::Pattern::OnePlume, fields::Pattern::FourPlumes};
  constexpr int kFrame = 50;
  Renderer renderer(usx_array(), fields::make(kDrawn[0], kFrame, kCells));
  MapFigure figure;
  figure.title = "What an array puts on the skin at some time of the loop, and what is felt of it";
  figure.scale = "over the largest";
  figure.columns = static_cast<int>(kWays.size());
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
    for (const Way way : kWays) {
      if (way == Way::Flat) continue;
      const Rendering r = renderer.render(way, target);
      figure.maps.push_back(map(to_string(way) + ", pressure", r.field.envelope, r.of_envelope));
      felt.push_back(map(to_string(way) + ", felt", r.felt.percept, r.of_felt));
    }
    figure.maps.insert(figure.maps.end(), felt.begin(), felt.end());
  }
  draw_maps(figure, path);
}

}  // namespace prostm::bench
