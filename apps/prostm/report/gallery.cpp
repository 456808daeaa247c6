#include "prostm/methods/gallery.hpp"

#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

Json row_of(const std::string& name, const methods::Rendering& rendering) {
  const Metrics &model = rendering.of_model, &felt = rendering.of_felt;
  Json row = {{"name", name},
              {"rmse", model.rmse},
              {"correlation", model.correlation},
              {"skill_8", model.skill_8},
              {"overlap", model.overlap},
              {"spill", model.spill},
              {"felt_skill_8", nullptr},
              {"percept", nullptr},
              {"sensation", nullptr}};
  if (!rendering.felt_at_all) return row;
  row["felt_skill_8"] = felt.skill_8;
  row["percept"] = 1e6 * rendering.felt.largest;
  const double level = sensation_level(rendering.felt.largest, usx_array());
  if (!std::isnan(level)) row["sensation"] = level;
  return row;
}

}  // namespace

void make_gallery(const ReportWork& work, Json& document) {
  const auto targets = methods::render_gallery([&](double share) { work.progress(share); });
  Json rows = Json::array();
  for (const methods::GalleryTarget& of : targets) {
    for (std::size_t w = 0; w < of.renderings.size(); ++w)
      rows.push_back(
          row_of(of.name + ", " + to_string(methods::kGalleryWays[w]), of.renderings[w]));
  }
  methods::draw_gallery_of_ways(targets, work.folder.path("gallery.svg"));
  document["blocks"].push_back(report::figure_block(
      "gallery.svg",
      "Generated targets, and the fields by Eq. (1) of the paper's paths made valid, of presets "
      "best "
      "and felt, and of AM; under each its RMSE and skill_8, and what is felt of it",
      "Nine targets, each with the paths and fields of four methods"));
  document["blocks"].push_back(report::table_block("By Eq. (1), and what the skin feels",
                                                   {{"name", "target and method"},
                                                    {"rmse", "Eq. (1): RMSE"},
                                                    {"correlation", "correlation"},
                                                    {"skill_8", "skill_8"},
                                                    {"overlap", "overlap"},
                                                    {"spill", "spill"},
                                                    {"felt_skill_8", "skin: skill_8"},
                                                    {"percept", "strongest percept", "µm", 3},
                                                    {"sensation", "above threshold", "dB", 1}},
                                                   rows));
}

}  // namespace prostm::app
