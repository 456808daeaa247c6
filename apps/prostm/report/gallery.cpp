#include "plan/plan_pictures.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "report/metrics_table.hpp"
#include "report/report.hpp"

namespace prostm::app {

void make_gallery(const ReportWork& work, nlohmann::ordered_json& document) {
  constexpr std::array kShown = {Preset::PaperValid, Preset::Best};
  std::vector<GalleryField> list;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const fields::Pattern pattern : fields::kPatterns) {
    GalleryField& field = list.emplace_back();
    field.name = to_string(pattern);
    field.target = fields::make(pattern, fields::kFrames / 2);
    for (const Preset preset : kShown) {
      PipelineSettings settings;
      settings.plan.preset = preset;
      GalleryPlan& shown = field.plans.emplace_back();
      shown.name = name_of(preset);
      PlanStats stats;
      Planner(playable_plan_settings(settings, settings.emission_rate()), field.target.size())
          .plan(field.target, shown.plan, stats);
      const GainLaw gain = settings.plan.gain_law();
      const SegmentPressures pressures = played(field.target, shown.plan, settings);
      shown.rendered.resize(field.target.size());
      quasi_static_field(shown.plan, 0, field.target, settings.plan.sigma, gain, shown.rendered,
                         &pressures);
      shown.metrics =
          score_plan(field.target, shown.plan, 0, settings.plan.sigma, gain, &pressures);
      rows.push_back(metrics_row(field.name + ", " + shown.name, shown.metrics));
    }
    work.progress(static_cast<double>(list.size()) / static_cast<double>(fields::kPatterns.size()));
  }
  draw_gallery({"Nine targets and what is planned for them"}, list,
               work.folder.path("gallery.svg"));
  document["blocks"].push_back(report::figure_block(
      "gallery.svg",
      "Generated targets, the field of the paper's paths made valid, and that of preset best, by "
      "Eq. (1); under each its RMSE and skill_8",
      "Nine targets, each with the paths and fields of two presets"));
  document["blocks"].push_back(
      report::table_block("By Eq. (1)", metrics_columns("target and preset"), rows));
}

}  // namespace prostm::app
