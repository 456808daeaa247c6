#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/run_all.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/methods/comparison.hpp"
#include "report/metrics_table.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;
using methods::kWays;
using methods::Means;
using methods::Way;
using AllMeans = std::array<Means, kWays.size()>;

Json mean(const Distribution& of) {
  return of.count() > 0 ? Json(of.summary().mean) : Json(nullptr);
}

/// Sensation level of a mean percept [dB].
Json sensation(const Distribution& percept_um) {
  return sensation_value(1e-6 * percept_um.summary().mean);
}

Json shape_rows(const AllMeans& means) {
  Json rows = Json::array();
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means& m = means[w];
    const bool model = kWays[w] != Way::Flat;  // which makes no paths
    const Distribution& strength = m.level[static_cast<std::size_t>(methods::Equal::Drive)].percept;
    const auto of_model = [&](const Distribution& d) { return model ? mean(d) : Json(nullptr); };
    rows.push_back({{"way", to_string(kWays[w])},
                    {"shape", of_model(m.model_skill)},
                    {"felt_shape", mean(m.felt_skill_8)},
                    {"felt_strength", strength.count() > 0 ? sensation(strength) : Json(nullptr)},
                    {"spill", of_model(m.model_spill)},
                    {"rmse", of_model(m.rmse)},
                    {"correlation", of_model(m.correlation)},
                    {"model_overlap", of_model(m.model_overlap)},
                    {"skill_8", mean(m.skill_8)},
                    {"overlap", mean(m.overlap)},
                    {"felt_correlation", mean(m.felt_correlation)},
                    {"felt_overlap", mean(m.felt_overlap)},
                    {"ghosts", mean(m.ghosts)}});
  }
  return rows;
}

Json level_rows(const AllMeans& means, methods::Equal equal) {
  Json rows = Json::array();
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means::Level& level = means[w].level[static_cast<std::size_t>(equal)];
    if (level.pressure.count() == 0) continue;
    rows.push_back({{"way", to_string(kWays[w])},
                    {"pressure", mean(level.pressure)},
                    {"lobe", mean(level.lobe)},
                    {"percept", mean(level.percept)},
                    {"sensation", sensation(level.percept)},
                    {"intensity", mean(level.intensity)},
                    {"ghost", mean(level.ghost)}});
  }
  return rows;
}

void add_tables(const AllMeans& means, Json& blocks) {
  blocks.push_back(report::table_block(
      "Quality, with the felt strength when the largest drive is equal; then other measures by "
      "Eq. (1), of the envelope (the highest radiation pressure that the array puts on each cell), "
      "and of the percept, all after the gain of least squares",
      {{"way", "way"},
       {"shape", at_common_width("shape by Eq. (1)"), "", 2},
       {"felt_shape", "felt shape", "", 2},
       {"felt_strength", "felt strength", "dB above threshold", 1},
       {"spill", at_common_width("spill")},
       {"rmse", "RMSE by Eq. (1)"},
       {"correlation", "correlation by Eq. (1)"},
       {"model_overlap", "overlap by Eq. (1)"},
       {"skill_8", "S_8.5 of the envelope"},
       {"overlap", "overlap of the envelope"},
       {"felt_correlation", "correlation of the percept"},
       {"felt_overlap", "overlap of the percept"},
       {"ghosts", "ghosts", "", 2}},
      shape_rows(means)));
  struct Equality {
    methods::Equal equal;
    const char* caption;
  };
  for (const Equality& of :
       {Equality{methods::Equal::Drive, "Levels, when the largest drive is equal"},
        Equality{methods::Equal::Power, "Levels, when the mean power is that of best"},
        Equality{methods::Equal::Percept, "Levels, when the strongest percept is that of best"}}) {
    blocks.push_back(report::table_block(of.caption,
                                         {{"way", "way"},
                                          {"pressure", "highest radiation pressure", "Pa", 2},
                                          {"lobe", "radiation pressure beside the paths", "Pa", 2},
                                          {"percept", "strongest percept", "µm", 3},
                                          {"sensation", "felt strength", "dB above threshold", 1},
                                          {"intensity", "strength of all", "µm", 3},
                                          {"ghost", "strongest ghost", "µm", 3}},
                                         level_rows(means, of.equal)));
  }
}

/// Renders fields spread over the time of each scene in every way, on two threads; nothing for
/// fields without a percept. @return scene by scene
std::vector<std::vector<methods::Rendering>> rendered(const ReportWork& work, int frames) {
  std::vector<TargetField> targets;
  for (const char* scene : kReportScenes) {
    const RecordingReader recording = recorded_fields(work, scene);
    for (int i = 0; i < frames; ++i) {
      const int frame = (2 * i + 1) * recording.frames() / (2 * frames);
      targets.push_back(recorded_field(recording, frame));
    }
  }
  std::vector<std::vector<methods::Rendering>> out(targets.size());
  std::atomic<int> done = 0;
  WorkerPool pool(2);
  run_all(pool, static_cast<int>(targets.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    methods::Renderer renderer(usx_array(), targets[at], 1);
    out[at] = methods::render_ways(renderer, targets[at]);
    work.progress(static_cast<double>(++done) / static_cast<double>(targets.size()));
  });
  return out;
}

}  // namespace

void make_methods(const ReportWork& work, Json& document) {
  const int frames = work.full_or_quick(12, 1, "fields of each scene", document);
  const SensationInterval interval = sensation_interval(usx_array());
  document["values"] = {
      {"tried", frames}, {"interval_below", interval.below}, {"interval_above", interval.above}};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "The array of 16 × 16 transducers plays the plans of each method for {/values/tried} fields "
      "of each scene, spread over its time; transducers follow their drives with a lag, and the "
      "skin is the model of docs/design/skin.md. Levels depend on the quantity that is held equal, "
      "so there are three tables of them. Felt strength is the level above the published threshold "
      "of "
      "touch, for the sound level that was measured with this array; 95 % of people and arrays lie "
      "{/values/interval_below:0} dB below it to {/values/interval_above:0} dB above it. Other "
      "levels are for the nominal amplitude. Fields are left out if "
      "the loop of a method takes too "
      "long for its percept to be computed. \"Flat\" is an idealised uniform field that no array "
      "can make. Ghosts are maxima of the percept, above half of its peak, where the target has no "
      "pressure."));
  const std::vector<std::vector<methods::Rendering>> renderings = rendered(work, frames);
  for (std::size_t s = 0; s < kReportScenes.size(); ++s) {
    AllMeans means;
    int felt = 0;
    for (int i = 0; i < frames; ++i) {
      const auto& of =
          renderings[s * static_cast<std::size_t>(frames) + static_cast<std::size_t>(i)];
      if (of.empty()) continue;
      methods::add_ways(of, means);
      ++felt;
    }
    if (felt == 0) {
      throw InputError(
          std::string("no field of ") + kReportScenes[s] +
          " has plans whose loops are all short enough to be felt; try another --seed");
    }
    document["values"]["felt"].push_back(felt);
    blocks.push_back(
        report::heading_block(fmt::format("{}, {{/values/felt/{}}} fields", kReportScenes[s], s)));
    add_tables(means, blocks);
  }
  report::add_verdicts(
      blocks, {report::not_comparable("The paper simulates neither its array nor the skin.")});
  if (work.quick) {
    document["lowered"].push_back("no picture of the methods");
    return;
  }
  methods::draw_ways(work.folder.path("methods.svg"));
  blocks.push_back(report::figure_block(
      "methods.svg",
      "One wide plume and four thin ones, generated: the target, the pressure that the array puts "
      "on the skin, and what is felt of it",
      "Maps of targets, pressures and percepts for each way to render"));
}

}  // namespace prostm::app
