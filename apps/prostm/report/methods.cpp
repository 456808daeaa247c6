#include <fmt/format.h>

#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/input_error.hpp"
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
                    {"rmse", of_model(m.rmse)},
                    {"correlation", of_model(m.correlation)},
                    {"model_overlap", of_model(m.model_overlap)},
                    {"skill_8", mean(m.skill_8)},
                    {"overlap", mean(m.overlap)},
                    {"felt_skill_8", mean(m.felt_skill_8)},
                    {"felt_correlation", mean(m.felt_correlation)},
                    {"felt_overlap", mean(m.felt_overlap)},
                    {"ghosts", mean(m.ghosts)},
                    {"percept", mean(strength)},
                    {"sensation", strength.count() > 0 ? sensation(strength) : Json(nullptr)}});
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
      "Shapes, after the gain of least squares: by Eq. (1); of the envelope, the highest pressure "
      "that the array puts on each cell; and of what the skin feels, with the strength of the "
      "strongest place when the largest drive is equal",
      {{"way", "way"},
       {"rmse", "Eq. (1): RMSE"},
       {"correlation", "correlation"},
       {"model_overlap", "overlap"},
       {"skill_8", "array: skill_8"},
       {"overlap", "overlap"},
       {"felt_skill_8", "skin: skill_8"},
       {"felt_correlation", "correlation"},
       {"felt_overlap", "overlap"},
       {"ghosts", "ghosts", "", 2},
       {"percept", "strongest percept", "µm", 3},
       {"sensation", "above threshold", "dB", 1}},
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
                                          {"pressure", "highest pressure", "Pa", 2},
                                          {"lobe", "beside the paths", "Pa", 2},
                                          {"percept", "strongest percept", "µm", 3},
                                          {"sensation", "above threshold", "dB", 1},
                                          {"intensity", "strength of all", "µm", 3},
                                          {"ghost", "strongest ghost", "µm", 3}},
                                         level_rows(means, of.equal)));
  }
}

}  // namespace

void make_methods(const ReportWork& work, Json& document) {
  const int frames = work.full_or_quick(12, 1);
  const double interval = std::round(sensation_interval(usx_array()).above);
  document["values"] = {{"tried", frames}, {"interval", interval}};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "The array of 16 × 16 transducers plays the plans of each method for {/values/tried} fields "
      "of each scene, spread over its time; transducers follow their drives with a lag, and the "
      "skin is the model of docs/design/skin.md. Levels depend on the quantity that is held equal, "
      "so there are three tables of them. Levels above the threshold of touch are for the sound "
      "level that was measured with this array; for 95 % of people and arrays they lie within "
      "{/values/interval} dB. Other levels are for the nominal amplitude. Fields are left out if "
      "the loop of a method takes too "
      "long for its percept to be computed. \"Flat\" is an idealised uniform field that no array "
      "can make. Ghosts are maxima of the percept, above half of its peak, where the target has no "
      "pressure."));
  const double all = 2.0 * frames;
  for (std::size_t s = 0; s < kReportScenes.size(); ++s) {
    const RecordingReader recording = recorded_fields(work, kReportScenes[s]);
    AllMeans means;
    int felt = 0;
    for (int i = 0; i < frames; ++i) {
      const int frame = (2 * i + 1) * recording.frames() / (2 * frames);
      const TargetField target = recorded_field(recording, frame);
      methods::Renderer renderer(usx_array(), target);
      if (methods::add_ways(renderer, target, means)) ++felt;
      work.progress((static_cast<double>(s) * frames + i + 1.0) / all);
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
  if (work.quick) return;
  methods::draw_ways(work.folder.path("methods.svg"));
  blocks.push_back(report::figure_block(
      "methods.svg",
      "One wide plume and four thin ones, generated: the target, the pressure that the array puts "
      "on the skin, and what is felt of it",
      "Maps of targets, pressures and percepts for each way to render"));
}

}  // namespace prostm::app
