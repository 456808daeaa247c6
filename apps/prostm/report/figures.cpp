/// The paper's Figs. 1 to 3.
#include <fmt/format.h>

#include <limits>

#include "plan/plan_pictures.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "report/metrics_table.hpp"
#include "report/report.hpp"
#include "run/instant.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

/// Stores the first plan after a given time.
class FirstPlan final : public RunObserver {
 public:
  FirstPlan(const ReportWork& work, double from) : work_(work), from_(from) {}
  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    if (plan_.status == PlanStatus::Planned) return false;  // arrived before the run ended
    if (contact.target.time < from_ || plan.status != PlanStatus::Planned) return true;
    contact_ = contact;
    plan_ = plan;
    return false;
  }
  bool on_progress(double time) override {
    work_.progress(std::min(1.0, time / from_));
    return plan_.status != PlanStatus::Planned;
  }
  const WorldFrame& contact() const { return contact_; }
  const PlanFrame& plan() const { return plan_; }

 private:
  const ReportWork& work_;
  double from_;
  WorldFrame contact_;
  PlanFrame plan_;
};

/// A plan of the paper's preset with its steps.
struct TracedPlan {
  Plan plan;
  PlanStats stats;
  PlanTrace trace;
};

TracedPlan traced_plan(const TargetField& target, const PipelineSettings& settings) {
  TracedPlan out;
  Planner planner(playable_plan_settings(settings, settings.emission_rate()), target.size());
  planner.plan(target, out.plan, out.stats, &out.trace);
  return out;
}

PlanFigure figure_of(const TargetField& target, const TracedPlan& traced,
                     const PipelineSettings& settings, const std::string& title) {
  PlanFigure figure = as_figure(target, traced.plan, traced.trace, settings);
  const SegmentPressures pressures = played(target, traced.plan, settings);
  figure.metrics =
      score_plan(target, traced.plan, 0, settings.plan.sigma, settings.plan.gain_law(), &pressures);
  figure.title = title;
  return figure;
}

/// Our steps on the paper's own field, and the paper's steps as digitised from its figure.
void add_papers_field(const ReportWork& work, const PipelineSettings& settings, Json& document) {
  if (!work.paper_file("fig2.field.json") || !work.paper_file("fig2.json")) {
    report::add_verdicts(document["blocks"],
                         {report::not_comparable("The paper gives no number for these steps, and "
                                                 "its own field is not part of prostm.")});
    return;
  }
  const std::string name = work.paper_data + "/fig2.json";
  const TargetField target = read_field(work.paper_data + "/fig2.field.json", {});
  const DigitisedFigure other = digitised_figure_from_json(
      *work.paper_file("fig2.json"), name, target, settings.plan.gain_law(), settings.plan.speed);
  const TracedPlan ours = traced_plan(target, settings);
  const PlanFigure figure = figure_of(target, ours, settings, "The paper's field, preset paper"),
                   beside = as_figure(target, other, settings, "The paper's own steps, digitised");
  draw_plan(figure, work.folder.path("figure-2-paper.svg"), &beside);
  Json rows = Json::array();
  rows.push_back(metrics_row("the paper's paths, digitised", beside.metrics));
  rows.back()["marked"] = true;
  rows.push_back(metrics_row("prostm, preset paper", figure.metrics));
  document["blocks"].push_back(report::figure_block(
      "figure-2-paper.svg",
      "The field of the paper's Fig. 2: above our steps, below the paper's, as they were read off "
      "its figure",
      "Twelve panels: target, clusters, initial tour, split tours, refined paths and reconstructed "
      "field, ours and the paper's"));
  document["blocks"].push_back(
      report::table_block("By Eq. (1), on the paper's field", metrics_columns("paths"), rows));
  report::add_verdicts(
      document["blocks"],
      {report::compare(
          "On the paper's field preset paper has a shape by Eq. (1) of", figure.metrics.skill_0,
          {beside.metrics.skill_0, std::numeric_limits<double>::infinity()}, {2, ""})});
}

/// A target's plan by one planner, for the picture and the table.
GalleryPlan planned(const std::string& name, const TargetField& target, const Plan& plan,
                    const PipelineSettings& settings) {
  GalleryPlan out;
  out.name = name;
  out.plan = plan;
  out.rendered.resize(target.size());
  const double sigma = plan.foci.empty() ? settings.plan.sigma : settings.am.sigma;
  const SegmentPressures pressures = played(target, plan, settings);
  quasi_static_field(plan, 0, target, sigma, settings.plan.gain_law(), out.rendered, &pressures);
  out.metrics = score_plan(target, plan, 0, sigma, settings.plan.gain_law(), &pressures);
  return out;
}

GalleryField compared(const ReportWork& work, const std::string& scene, int frame) {
  PipelineSettings settings = work.settings(scene);
  GalleryField field;
  field.name = scene;
  field.target = recorded_field(recorded_fields(work, scene), frame);
  Plan plan;
  PlanStats stats;
  for (const Preset preset : {Preset::PaperValid, Preset::Best}) {
    settings.plan.preset = preset;
    Planner(playable_plan_settings(settings, settings.emission_rate()), field.target.size())
        .plan(field.target, plan, stats);
    field.plans.push_back(
        planned("PRO-STM, " + std::string(name_of(preset)), field.target, plan, settings));
  }
  AmPlanner(am_settings(settings, settings.emission_rate()), field.target.size())
      .plan(field.target, plan, stats);
  field.plans.push_back(planned("AM", field.target, plan, settings));
  return field;
}

}  // namespace

void make_figure_one(const ReportWork& work, Json& document) {
  constexpr double kFrom = 3.0;  // jets have reached the hand [s]
  PipelineSettings settings = work.settings("four-plumes");
  settings.side_view = true;
  Pipeline pipeline(settings, work.hand(settings));
  FirstPlan first(work, kFrom);
  RunOptions options;
  options.mode = RunMode::AsFastAsPossible;
  options.seconds = 10.0 * kFrom;
  const RunSummary summary = run(pipeline, settings, options, first);
  if (summary.failure) std::rethrow_exception(summary.failure);
  if (first.plan().status != PlanStatus::Planned)
    throw InputError("no pressure reached the hand of Fig. 1; try another --seed");
  draw_instant(first.contact(), first.plan(), settings, work.folder.path("figure-1.svg"));
  document["values"] = {{"time_s", first.contact().target.time}};
  document["blocks"].push_back(report::figure_block(
      "figure-1.svg",
      "The scripted hand in four plumes after {/values/time_s:2} s: from the side, the pressure on "
      "its skin with the paths of preset best, and the field that these make by Eq. (1)",
      "The scene from the side, the target on the skin with four closed paths, and their field"));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("The paper's Fig. 1 has no numbers.")});
}

void make_figure_two(const ReportWork& work, Json& document) {
  PipelineSettings settings = work.settings("one-plume");
  settings.plan.preset = Preset::Paper;
  const RecordingReader recording = recorded_fields(work, "one-plume");
  const int frame = recording.frames() / 2;
  const TargetField target = recorded_field(recording, frame);
  const TracedPlan traced = traced_plan(target, settings);
  const PlanFigure figure = figure_of(target, traced, settings, "One plume, preset paper");
  draw_plan(figure, work.folder.path("figure-2.svg"));
  document["values"] = {{"field", frame + 1}, {"clusters", traced.stats.clusters}};
  document["blocks"].push_back(report::figure_block(
      "figure-2.svg",
      "Field {/values/field} of one plume: {/values/clusters} clusters, the tour through them, the "
      "tours that are short enough, their refined paths, and the field of these",
      "Six panels: target, clusters, initial tour, split tours, refined paths, reconstruction"));
  Json rows = Json::array({metrics_row("prostm, preset paper", figure.metrics)});
  document["blocks"].push_back(
      report::table_block("By Eq. (1), on this field", metrics_columns("paths"), rows));
  add_papers_field(work, settings, document);
}

void make_figure_three(const ReportWork& work, Json& document) {
  std::vector<GalleryField> fields;
  Json rows = Json::array();
  const int frame = recorded_fields(work, kReportScenes[0]).frames() / 2;
  for (const char* scene : kReportScenes) {
    const GalleryField& field = fields.emplace_back(compared(work, scene, frame));
    for (const GalleryPlan& plan : field.plans)
      rows.push_back(metrics_row(field.name + ", " + plan.name, plan.metrics));
  }
  GalleryPage page;
  page.title = "Target, PRO-STM and AM";
  page.note = "Eq. (1), as played; how strongly a pressure is felt differs between the methods";
  page.caption = GalleryCaption::Correlation;
  page.fields_in_row = 1;
  draw_gallery(page, fields, work.folder.path("figure-3.svg"));
  document["values"] = {{"field", frame + 1}};
  document["blocks"].push_back(
      report::figure_block("figure-3.svg",
                           "Field {/values/field} of each scene. AM puts four points on one wide "
                           "plume and four points on "
                           "four thin ones; paths cover what they can of either",
                           "For both scenes: target, fields of PRO-STM and of AM"));
  document["blocks"].push_back(report::table_block("By Eq. (1), on these fields",
                                                   metrics_columns("field and method"), rows));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("The paper compares the methods by pictures, and "
                                               "calls Eq. (1) unsuited to compare them.")});
}

}  // namespace prostm::app
