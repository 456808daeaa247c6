#include "prostm/methods/gallery.hpp"

#include "report/metrics_table.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

std::vector<report::Column> columns() {
  std::vector<report::Column> out = metrics_columns("target and method");
  out.push_back({"felt_skill_8", "skin: skill_8"});
  out.push_back({"percept", "strongest percept", "µm", 3});
  out.push_back({"sensation", "above threshold", "dB", 1});
  return out;
}

Json row_of(const std::string& name, const methods::Rendering& rendering) {
  Json row = metrics_row(name, rendering.of_model);
  const bool felt = rendering.felt_at_all;
  row["felt_skill_8"] = felt ? Json(rendering.of_felt.skill_8) : Json(nullptr);
  row["percept"] = felt ? Json(1e6 * rendering.felt.largest) : Json(nullptr);
  row["sensation"] = felt ? sensation_value(rendering.felt.largest) : Json(nullptr);
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
      "best and felt, and of AM; under each its RMSE and skill_8, and what is felt of it",
      "Nine targets, each with the paths and fields of four methods"));
  document["blocks"].push_back(
      report::table_block("By Eq. (1), and what the skin feels", columns(), rows));
}

}  // namespace prostm::app
