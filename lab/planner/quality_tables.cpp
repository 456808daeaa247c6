/// The tables of the quality bench.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "planner/quality.hpp"

namespace prostm::bench {
namespace {

constexpr int kWarmFrom = 10;  // first frame on which warm planners are judged

/// Metrics of one planner and of its baselines, averaged over the same frames.
struct Comparison {
  double frames = 0, frames_worse = 0;  // RMSE or S_8.5 worse than both baselines on that frame
  Metrics ours;
  double rmse = 0, blur_error = 0, coverage = 0;  // the better baseline's; blur error = 1 − S_8.5
  double textbook_rmse = 0;
  double rmse_ratio() const { return ours.rmse / rmse; }
  double blur_ratio() const { return (1.0 - ours.skill_8) / blur_error; }
};

bool counts(const Outcome& outcome, int frame) {
  return !outcome.warm || frame >= kWarmFrom;
}

/// Compares with the better, metric by metric, of paper-valid and the textbook's medians.
Comparison compare(const Outcome& ours, const SequenceOutcome& all) {
  const Outcome& valid = all.planners.front();
  Comparison c;
  for (const int frame : all.frames) c.frames += counts(ours, frame) ? 1.0 : 0.0;
  if (c.frames == 0.0) return c;
  Metrics textbook, paper;
  for (std::size_t f = 0; f < all.frames.size(); ++f) {
    if (!counts(ours, all.frames[f])) continue;
    add_share(ours.metrics[f], 1.0 / c.frames, c.ours);
    add_share(all.textbook.metrics[f], 1.0 / c.frames, textbook);
    add_share(valid.metrics[f], 1.0 / c.frames, paper);
    const Metrics &m = ours.metrics[f], &a = all.textbook.metrics[f], &b = valid.metrics[f];
    const bool worse =
        m.rmse > std::min(a.rmse, b.rmse) || m.skill_8 < std::max(a.skill_8, b.skill_8);
    c.frames_worse += worse ? 1.0 : 0.0;
  }
  c.rmse = std::min(textbook.rmse, paper.rmse);
  c.textbook_rmse = textbook.rmse;
  c.blur_error = 1.0 - std::max(textbook.skill_8, paper.skill_8);
  c.coverage = std::max(textbook.coverage, paper.coverage);
  return c;
}

void print_heading(const std::string& title) {
  fmt::print("\n{}\n{:<42} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>9} {:>8} {:>7} {:>7} {:>8}\n",
             title, "", "RMSE", "corr.", "cover", "S_0", "S_8.5", "p50 us", "p99 us", "textbook",
             "RMSE", "1-S_8.5", "cover");
  fmt::print("{:<42} {:>39} {:>28} {:>7} {:>7} {:>8}\n", "", "", "/ ours", "ratio", "ratio",
             "diff.");
}

void print_metrics(const std::string& name, const Metrics& m) {
  fmt::print("{:<42} {:>7.4f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f}", name, m.rmse, m.correlation,
             m.coverage, m.skill_0, m.skill_8);
}

void print_outcome(const Outcome& outcome, const SequenceOutcome& all, bool compared) {
  const Comparison c = compare(outcome, all);
  if (c.frames == 0.0) return;
  print_metrics(outcome.name, c.ours);
  const Summary time = outcome.times.total(), slow = all.textbook.times.total();
  if (time.n == 0) {
    fmt::print(" {:>9} {:>9} {:>8}", "", "", "");
  } else {
    fmt::print(" {:>9.1f} {:>9.1f} {:>8.2f}", time.p50, time.p99, slow.p50 / time.p50);
  }
  if (compared) {
    fmt::print(" {:>7.3f} {:>7.3f} {:>+8.3f}", c.rmse_ratio(), c.blur_ratio(),
               c.ours.coverage - c.coverage);
  }
  fmt::print("\n");
}

/// For the scenes of the paper, prints its stage times beside ours.
void print_stages(const SequenceOutcome& all) {
  constexpr std::array kNames{"init", "k-means", "tour", "split", "resample", "refine", "total"};
  struct PaperRow {
    const char* scene;
    std::array<double, kStages> mean;
  };
  constexpr std::array kPaper{PaperRow{"one-plume", {285, 1548, 2550, 744, 12, 17896, 24303}},
                              PaperRow{"four-plumes", {142, 948, 1224, 324, 10, 11120, 14640}}};
  for (const PaperRow& paper : kPaper) {
    if (all.name != paper.scene) continue;
    fmt::print("{:<42}", "stages, p50 us");
    for (const char* name : kNames) fmt::print(" {:>9}", name);
    fmt::print("\n{:<42}", "the paper's Table I, i7-6820HK");
    for (const double t : paper.mean) fmt::print(" {:>9.0f}", t);
    fmt::print("\n");
    std::vector<const Outcome*> rows{&all.textbook};
    for (const Outcome& o : all.planners) rows.push_back(&o);
    for (const Outcome* o : rows) {
      fmt::print("{:<42}", o->name);
      for (const Distribution& d : o->times.stage) fmt::print(" {:>9.1f}", d.summary().p50);
      fmt::print("\n");
    }
  }
}

double mean_of(const std::vector<Metrics>& all, double Metrics::*member) {
  double sum = 0.0;
  for (const Metrics& m : all) sum += m.*member;
  return all.empty() ? 0.0 : sum / static_cast<double>(all.size());
}

/// One planner over all sequences, with equal weight for each.
struct Means {
  Metrics ours;
  double rmse = 0, blur_error = 0, sequences = 0, textbook_rmse = 0;
  double time = 0, textbook_time = 0, longest = 0;  // sums of medians, largest p99 [µs]
  double least_coverage = HUGE_VAL;  // smallest difference to the baselines' in any sequence
  double frames = 0, frames_worse = 0;
  int worse_rmse = 0, worse_skill = 0, worse_coverage = 0;
};

Means means_of(const std::vector<SequenceOutcome>& outcomes, std::size_t planner) {
  Means m;
  for (const SequenceOutcome& all : outcomes) {
    const Comparison c = compare(all.planners[planner], all);
    if (c.frames == 0.0) continue;
    add_share(c.ours, 1.0, m.ours);
    m.rmse += c.rmse;
    m.blur_error += c.blur_error;
    m.textbook_rmse += c.textbook_rmse;
    const Summary time = all.planners[planner].times.total();
    m.time += time.p50;
    m.textbook_time += all.textbook.times.total().p50;
    m.longest = std::max(m.longest, time.p99);
    m.sequences += 1.0;
    m.least_coverage = std::min(m.least_coverage, c.ours.coverage - c.coverage);
    m.frames += c.frames;
    m.frames_worse += c.frames_worse;
    m.worse_rmse += c.rmse_ratio() > 1.0 ? 1 : 0;
    m.worse_skill += c.blur_ratio() > 1.0 ? 1 : 0;
    m.worse_coverage += c.ours.coverage < c.coverage - 0.01 ? 1 : 0;
  }
  return m;
}

void print_means(const std::vector<SequenceOutcome>& outcomes) {
  fmt::print(
      "\nMean over {} fields, against the better of paper-valid and the textbook's medians (warm "
      "planners from frame {} on)\n",
      outcomes.size(), kWarmFrom);
  fmt::print(
      "{:<20} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8}   {:<25} {:>9} {:>10} {:>10} {:>9} {:>9}\n", "",
      "RMSE", "corr.", "S_8.5", "RMSE", "1-S_8.5", "least", "fields worse in", "frames", "mean p50",
      "worst p99", "textbook", "RMSE over");
  fmt::print(
      "{:<20} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8}   {:<25} {:>9} {:>10} {:>10} {:>9} {:>9}\n", "",
      "", "", "", "ratio", "ratio", "cover", "RMSE, S_8.5, cover by .01", "worse", "us", "us",
      "/ ours", "textbook");
  for (std::size_t p = 0; p < outcomes.front().planners.size(); ++p) {
    const Means m = means_of(outcomes, p);
    if (m.sequences == 0.0) continue;
    fmt::print(
        "{:<20} {:>7.4f} {:>7.3f} {:>7.3f} {:>7.3f} {:>8.3f} {:>+8.3f}   {:<25} {:>9} {:>10.1f} "
        "{:>10.1f} {:>9.2f} {:>9.3f}\n",
        outcomes.front().planners[p].name, m.ours.rmse / m.sequences,
        m.ours.correlation / m.sequences, m.ours.skill_8 / m.sequences, m.ours.rmse / m.rmse,
        (m.sequences - m.ours.skill_8) / m.blur_error, m.least_coverage,
        fmt::format("{}, {}, {}", m.worse_rmse, m.worse_skill, m.worse_coverage),
        fmt::format("{:.0f}/{:.0f}", m.frames_worse, m.frames), m.time / m.sequences, m.longest,
        m.textbook_time / m.time, m.ours.rmse / m.textbook_rmse);
  }
}

/// Prints S_8.5 and RMSE of each planner under each disturbance, and how often it beats
/// paper-valid.
void print_disturbances(const std::vector<SequenceOutcome>& outcomes) {
  const std::vector<Disturbance> list = disturbances(PlanSettings{}.sigma);
  fmt::print(
      "\nDisturbed: mean RMSE, mean S_8.5, and share of frames where S_8.5 is above "
      "paper-valid's\n{:<20}",
      "");
  for (const Disturbance& d : list) fmt::print(" {:>25}", d.name);
  fmt::print("\n");
  for (std::size_t p = 0; p < outcomes.front().planners.size(); ++p) {
    fmt::print("{:<20}", outcomes.front().planners[p].name);
    for (std::size_t d = 0; d < list.size(); ++d) {
      double rmse = 0, skill = 0, frames = 0, better = 0;
      for (const SequenceOutcome& all : outcomes) {
        const std::vector<Metrics>&ours = all.planners[p].disturbed[d],
              &valid = all.planners.front().disturbed[d];
        rmse += mean_of(ours, &Metrics::rmse) / static_cast<double>(outcomes.size());
        skill += mean_of(ours, &Metrics::skill_8) / static_cast<double>(outcomes.size());
        for (std::size_t f = 0; f < ours.size(); ++f) {
          frames += 1.0;
          better += ours[f].skill_8 > valid[f].skill_8 ? 1.0 : 0.0;
        }
      }
      fmt::print(" {:>11.4f} {:>6.3f} {:>4.0f} %", rmse, skill, 100.0 * better / frames);
    }
    fmt::print("\n");
  }
}

void print_violations(const std::vector<SequenceOutcome>& outcomes) {
  fmt::print("\n{:<20} {:>8} {:>10} {:>10} {:>22} {:>11} {:>16}\n", "violations", "plans",
             "> 140.5 mm", "crossings", "< 0.9 sigma (pairs)", "non-finite", "controls lost");
  for (std::size_t p = 0; p < outcomes.front().planners.size(); ++p) {
    Violations v;
    int lost = 0, controls = 0;
    for (const SequenceOutcome& all : outcomes) {
      v.add(all.planners[p].violations);
      lost += all.planners[p].controls_lost;
      controls += all.planners[p].controls;
    }
    fmt::print("{:<20} {:>8} {:>10} {:>10} {:>22} {:>11} {:>16}\n",
               outcomes.front().planners[p].name, v.plans, v.long_paths, v.crossings,
               fmt::format("{} ({})", v.near_plans, v.near_pairs), v.non_finite,
               fmt::format("{} of {}", lost, controls));
  }
}

Row value_row(const std::string& name, const std::vector<Metrics>& metrics,
              const std::vector<Metrics>& baseline, double Metrics::*member) {
  Distribution ours, theirs;
  for (const Metrics& m : metrics) ours.add(m.*member);
  for (const Metrics& m : baseline) theirs.add(m.*member);
  return {name, "1", ours.summary(), "textbook", theirs.summary().p50};
}

}  // namespace

void print(const SequenceOutcome& all) {
  print_heading(fmt::format("{} ({} frames, one thread, in turn)", all.name, all.frames.size()));
  print_outcome(all.textbook, all, false);
  print_outcome(all.tuned, all, false);
  for (const Outcome& planner : all.planners) print_outcome(planner, all, true);
  for (const Control& control : all.controls) {
    print_metrics("control: " + control.name, control.metrics);
    fmt::print("\n");
  }
  print_stages(all);
  std::fflush(stdout);
}

void print_summary(const std::vector<SequenceOutcome>& outcomes) {
  print_means(outcomes);
  print_disturbances(outcomes);
  print_violations(outcomes);
}

void append_rows(const std::vector<SequenceOutcome>& outcomes, std::vector<Row>& rows) {
  for (const SequenceOutcome& all : outcomes) {
    for (const Outcome& planner : all.planners) {
      const std::string name = fmt::format("planner/{}/{}", planner.name, all.name);
      rows.push_back(
          {name, "us", planner.times.total(), "textbook", all.textbook.times.total().p50});
      rows.push_back(
          value_row(name + "/rmse", planner.metrics, all.textbook.metrics, &Metrics::rmse));
      rows.push_back(
          value_row(name + "/skill_8", planner.metrics, all.textbook.metrics, &Metrics::skill_8));
    }
  }
}

}  // namespace prostm::bench
