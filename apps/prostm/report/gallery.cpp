#include "prostm/methods/gallery.hpp"

#include "prostm/fields/fields.hpp"
#include "report/metrics_table.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

Json row_of(const std::string& name, const methods::Rendering& rendering) {
  const bool felt = rendering.felt_at_all;
  return metrics_row(name, rendering.of_model, felt ? &rendering.of_felt : nullptr,
                     felt ? rendering.felt.largest : 0.0);
}

}  // namespace

void make_gallery(const ReportWork& work, Json& document) {
  const int count = work.full_or_quick(static_cast<int>(fields::kPatterns.size()), 4,
                                       "generated targets", document);
  const auto targets = methods::render_gallery(static_cast<std::size_t>(count),
                                               [&](double share) { work.progress(share); });
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
      "Each target with the paths and fields of four methods"));
  document["blocks"].push_back(
      report::table_block("Quality of each rendering with the 16 × 16 array at full drive",
                          metrics_columns("target and method", true), rows));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("The paper has none of these targets.")});
}

}  // namespace prostm::app
