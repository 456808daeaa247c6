#include "planner/am.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "planner/contenders.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/score/score.hpp"

namespace prostm::bench {
namespace {

constexpr double kPaperRate = 250.0;  // updates per second: "roughly 250 Hz on both test scenarios"
constexpr const char* kCaution =
    "The paper calls its model of the field \"not suited for a quantitative (e.g., RMSE) "
    "comparison "
    "of STM and AM\".";

constexpr std::array kSigmas{8e-3, 16e-3, 24e-3, 32e-3};  // [m]
constexpr std::array kCounts{2, 4, 8};

/// Table I of [B-1], with and without the emitter as an obstacle.
struct Published {
  const char* name;
  double rmse[kCounts.size()][kSigmas.size()];
};
constexpr Published kPublished[] = {
    {"[B-1], with emitter",
     {{.357, .283, .220, .197}, {.334, .242, .193, .186}, {.315, .227, .189, .157}}},
    {"[B-1], no emitter",
     {{.335, .268, .206, .180}, {.313, .228, .180, .170}, {.296, .210, .173, .168}}}};

Metrics score_am(const TargetField& target, const Plan& plan, double sigma) {
  return score_plan(target, plan, 0, sigma, GainLaw{});
}

/// Returns the mean RMSE over the frames of a sequence.
double mean_rmse(const Sequence& sequence, int frames, int count, double sigma) {
  AmSettings settings;
  settings.foci = count;
  settings.sigma = sigma;
  AmPlanner planner(settings, sequence.cells);
  double sum = 0.0, n = 0.0;
  for (const int f : spread(sequence.frames, frames)) {
    const TargetField target = sequence.field(f);
    Plan plan;
    PlanStats stats;
    if (planner.plan(target, plan, stats) != PlanStatus::Planned) continue;
    sum += score_am(target, plan, sigma).rmse;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

void print_table_row(const std::string& name, int count, const double (&rmse)[kSigmas.size()]) {
  fmt::print("  {:<22} {:>3}", name, count);
  for (const double value : rmse) fmt::print(" {:>7.3f}", value);
  fmt::print("\n");
}

GalleryPlan rendered(std::string name, const TargetField& target, const Plan& plan, double sigma,
                     const GainLaw& gain) {
  GalleryPlan out;
  out.name = std::move(name);
  out.plan = plan;
  out.rendered.resize(target.size());
  quasi_static_field(plan, 0, target, sigma, gain, out.rendered);
  out.metrics = score_plan(target, plan, 0, sigma, gain);
  return out;
}

GalleryField compared(const Sequence& sequence) {
  GalleryField field;
  field.name = sequence.name;
  field.target = sequence.field(sequence.frames - 1);  // where jets have settled
  Plan plan;
  PlanStats stats;
  for (Contender& stm : presets()) {
    if (stm.name() == "fast") continue;
    stm.begin(field.target.size());
    stm.plan(field.target, plan, stats);
    field.plans.push_back(rendered("STM, " + stm.name(), field.target, plan, stm.settings().sigma,
                                   stm.settings().gain_law()));
  }
  AmPlanner am(AmSettings{}, field.target.size());
  am.plan(field.target, plan, stats);
  field.plans.push_back(rendered("AM", field.target, plan, AmSettings{}.sigma, GainLaw{}));
  return field;
}

}  // namespace

void measure_am(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows) {
  constexpr int kRepeats = 5;
  fmt::print("\nAM, {} foci, the baseline of the paper (about {:.0f} updates a second there)\n",
             AmSettings{}.foci, kPaperRate);
  fmt::print("  {:<22} {:>13} {:>12} {:>7} {:>7}\n", "", "updates/s p50", "p99", "RMSE", "corr");
  for (const Sequence& sequence : sequences) {
    AmPlanner planner(AmSettings{}, sequence.cells);
    Distribution time, rmse, correlation;
    for (const int f : spread(sequence.frames, frames)) {
      const TargetField target = sequence.field(f);
      Plan plan;
      PlanStats stats;
      for (int r = 0; r < kRepeats; ++r) {
        if (planner.plan(target, plan, stats) == PlanStatus::Planned) time.add(stats.total);
      }
      if (plan.empty()) continue;
      const Metrics m = score_am(target, plan, AmSettings{}.sigma);
      rmse.add(m.rmse);
      correlation.add(m.correlation);
    }
    const Summary t = time.summary();
    if (t.n == 0) continue;
    fmt::print("  {:<22} {:>13.0f} {:>12.0f} {:>7.3f} {:>7.3f}\n", sequence.name, 1.0 / t.p50,
               1.0 / t.p99, rmse.summary().mean, correlation.summary().mean);
    Row row{sequence.name + ", am", "us", t, "the paper's AM", 1e6 / kPaperRate};
    for (double* value :
         {&row.ours.mean, &row.ours.deviation, &row.ours.p50, &row.ours.p99, &row.ours.max}) {
      *value *= 1e6;
    }
    rows.push_back(row);
  }
}

void measure_am_table(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows) {
  fmt::print("\nAM: RMSE of the model by fall-off and number of foci\n  {:<22} {:>3}", "", "N");
  for (const double sigma : kSigmas) fmt::print(" {:>4.0f} mm", 1e3 * sigma);
  fmt::print("\n");
  for (const Published& table : kPublished) {
    for (std::size_t n = 0; n < kCounts.size(); ++n)
      print_table_row(table.name, kCounts[n], table.rmse[n]);
  }
  double mean[kCounts.size()][kSigmas.size()] = {};
  for (const Sequence& sequence : sequences) {
    for (std::size_t n = 0; n < kCounts.size(); ++n) {
      double rmse[kSigmas.size()];
      for (std::size_t s = 0; s < kSigmas.size(); ++s) {
        rmse[s] = mean_rmse(sequence, frames, kCounts[n], kSigmas[s]);
        mean[n][s] += rmse[s] / static_cast<double>(sequences.size());
        Distribution one;
        one.add(rmse[s]);
        rows.push_back(
            {fmt::format("{}, am, {} foci, {:.0f} mm", sequence.name, kCounts[n], 1e3 * kSigmas[s]),
             "RMSE", one.summary(), kPublished[1].name, kPublished[1].rmse[n][s]});
      }
      print_table_row(sequence.name, kCounts[n], rmse);
    }
  }
  for (std::size_t n = 0; n < kCounts.size(); ++n)
    print_table_row("mean of all", kCounts[n], mean[n]);
}

void draw_am_picture(const std::vector<Sequence>& sequences, const std::string& path) {
  std::vector<GalleryField> fields;
  for (const Sequence& sequence : sequences) {
    fields.push_back(compared(sequence));
    fmt::print("{}, its last field:\n", sequence.name);
    for (const GalleryPlan& plan : fields.back().plans) {
      fmt::print("  {:<18} RMSE {:.3f}, correlation {:.3f}\n", plan.name, plan.metrics.rmse,
                 plan.metrics.correlation);
    }
  }
  fmt::print("{}\n", kCaution);
  GalleryPage page;
  page.title = "Target, STM and AM";
  page.note = kCaution;
  page.caption = GalleryCaption::Correlation;
  page.fields_in_row = 1;
  draw_gallery(page, fields, path);
}

}  // namespace prostm::bench
