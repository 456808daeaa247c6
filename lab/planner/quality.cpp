#include "planner/quality.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "planner/as_played.hpp"
#include "prostm/textbook/textbook.hpp"

namespace prostm::bench {
namespace {

/// Weights (pressure, length, intersection, bending) tried with the textbook; the first are its
/// own.
struct Weights {
  double pressure, length, intersection, bending;
};
constexpr std::array kWeightSets{Weights{3, 3, 1, 0.3}, Weights{3, 3, 1, 1}, Weights{3, 3, 1, 3},
                                 Weights{1, 3, 1, 0.3}, Weights{10, 3, 1, 0.3}};

PlanSettings textbook_settings(const Weights& w, int seed) {
  PlanSettings settings;
  settings.weight_pressure = w.pressure;
  settings.weight_length = w.length;
  settings.weight_intersection = w.intersection;
  settings.weight_bending = w.bending;
  settings.seed = seed;
  return settings;
}

double mean_rmse(const std::vector<Metrics>& all) {
  double sum = 0.0;
  for (const Metrics& m : all) sum += m.rmse;
  return sum / static_cast<double>(all.size());
}

/// Returns true if no metric of the field's shape prefers the control.
bool loses(const Metrics& control, const Metrics& plan) {
  return control.rmse > plan.rmse && control.correlation < plan.correlation &&
         control.skill_0 < plan.skill_0 && control.skill_8 < plan.skill_8 &&
         control.overlap < plan.overlap;
}

/// Scores the plans for one frame.
class FrameScorer {
 public:
  FrameScorer(const TargetField& target, const PlanSettings& settings)
      : target_(target), settings_(settings) {}

  Metrics score(const Plan& plan) const { return score_as_played(target_, plan, settings_); }
  void score(const Plan& plan, Outcome& outcome) const {
    outcome.metrics.push_back(score(plan));
    const std::vector<Disturbance> list = disturbances(settings_.sigma);
    outcome.disturbed.resize(list.size());
    for (std::size_t d = 0; d < list.size(); ++d) {
      outcome.disturbed[d].push_back(
          score_disturbed(target_, plan, 0, list[d], settings_.gain_law()));
    }
  }

 private:
  const TargetField& target_;
  const PlanSettings& settings_;
};

void add_controls(const TargetField& target, const Plan& other, int frame, int frames,
                  SequenceOutcome& outcome) {
  const PlanSettings settings;
  const std::vector<Control> table =
      controls(target, settings.sigma, settings.gain_law(), settings.max_length(), &other,
               static_cast<std::uint64_t>(frame) + 1);
  if (outcome.controls.empty()) {
    for (const Control& control : table) outcome.controls.push_back({control.name, {}});
  }
  for (std::size_t c = 0; c < table.size(); ++c) {
    add_share(table[c].metrics, 1.0 / frames, outcome.controls[c].metrics);
    for (Outcome& planner : outcome.planners) {
      ++planner.controls;
      planner.controls_lost += loses(table[c].metrics, planner.metrics.back()) ? 1 : 0;
    }
  }
}

/// Measures textbook and planners in turn on one scored frame, so that other load on the machine
/// affects all alike. Each seed of the textbook is a turn; cold planners take every fourth turn.
void measure_frame(const TargetField& target, std::vector<Contender>& contenders,
                   const std::vector<Plan>& warm_plans, int seeds, SequenceOutcome& outcome) {
  const PlanSettings settings;
  const FrameScorer scorer(target, settings);
  std::vector<Plan> plans = warm_plans;
  std::vector<Metrics> by_seed;
  for (int seed = 1; seed <= seeds; ++seed) {
    Plan plan;
    PlanStats stats;
    textbook::plan(target, textbook_settings(kWeightSets[0], seed), plan, stats);
    outcome.textbook.times.add(stats);
    by_seed.push_back(scorer.score(plan));
    for (std::size_t c = 0; c < contenders.size() && seed % 4 == 1; ++c) {
      if (contenders[c].variant().warm) continue;
      contenders[c].plan(target, plans[c], stats);
      outcome.planners[c].times.add(stats);
    }
  }
  outcome.textbook.metrics.push_back(median(by_seed));
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const PlanSettings& own = contenders[c].settings();
    if (!contenders[c].variant().warm) {
      outcome.planners[c].violations.add(plans[c], own.sigma, own.max_length());
    }
    scorer.score(plans[c], outcome.planners[c]);
  }
}

/// Scores the textbook's medians on the scored frames with every other set of weights; keeps the
/// best.
void tune_textbook(const std::vector<TargetField>& targets, int seeds, SequenceOutcome& outcome) {
  outcome.tuned.metrics = outcome.textbook.metrics;
  std::size_t best = 0;
  for (std::size_t w = 1; w < kWeightSets.size(); ++w) {
    std::vector<Metrics> medians;
    for (const TargetField& target : targets) {
      const PlanSettings settings;
      const FrameScorer scorer(target, settings);
      std::vector<Metrics> by_seed;
      for (int seed = 1; seed <= seeds; ++seed) {
        Plan plan;
        PlanStats stats;
        textbook::plan(target, textbook_settings(kWeightSets[w], seed), plan, stats);
        by_seed.push_back(scorer.score(plan));
      }
      medians.push_back(median(by_seed));
    }
    if (mean_rmse(medians) >= mean_rmse(outcome.tuned.metrics)) continue;
    outcome.tuned.metrics = medians;
    best = w;
  }
  const Weights& w = kWeightSets[best];
  outcome.tuned_weights =
      fmt::format("{:g}, {:g}, {:g}, {:g}", w.pressure, w.length, w.intersection, w.bending);
}

void show_progress(const std::string& name, int done, int of) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{}: {} of {} frames   ", name, done, of);
  if (done == of) fmt::print(stderr, "\r{:40}\r", "");
  std::fflush(stderr);
}

}  // namespace

void add_share(const Metrics& more, double share, Metrics& sum) {
  for (const Quantity<Metrics>& metric : quantities<Metrics>()) {
    const auto member = std::get<double Metrics::*>(metric.value);
    sum.*member += share * more.*member;
  }
}

void StageTimes::add(const PlanStats& s) {
  constexpr std::array kTimes{&PlanStats::init,  &PlanStats::kmeans,   &PlanStats::tour,
                              &PlanStats::split, &PlanStats::resample, &PlanStats::refine,
                              &PlanStats::total};
  for (std::size_t i = 0; i < kTimes.size(); ++i) stage[i].add(1e6 * s.*kTimes[i]);
}

SequenceOutcome measure(const Sequence& sequence, const TargetField& other,
                        std::vector<Contender>& contenders, const QualityOptions& options) {
  SequenceOutcome outcome;
  outcome.name = sequence.name;
  outcome.frames = spread(sequence.frames, options.frames);
  outcome.textbook.name = fmt::format("textbook, median of {}", options.seeds);
  for (Contender& contender : contenders) {
    contender.begin(std::max(sequence.cells, other.size()));
    Outcome& planner = outcome.planners.emplace_back();
    planner.name = contender.name();
    planner.warm = contender.variant().warm;
  }
  Plan other_plan;
  PlanStats stats;
  contenders.front().plan(other, other_plan, stats);

  // warm planners see every frame, in order; the others only the scored ones
  std::vector<TargetField> scored;
  const int frames = static_cast<int>(outcome.frames.size());
  for (int frame = 0; frame <= outcome.frames.back(); ++frame) {
    const bool is_scored = frame == outcome.frames[scored.size()];
    const TargetField target = sequence.field(frame);
    std::vector<Plan> plans(contenders.size());
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      if (!contenders[c].variant().warm) continue;
      const PlanSettings& own = contenders[c].settings();
      contenders[c].plan(target, plans[c], stats);
      outcome.planners[c].times.add(stats);
      outcome.planners[c].violations.add(plans[c], own.sigma, own.max_length());
    }
    if (!is_scored) continue;
    measure_frame(target, contenders, plans, options.seeds, outcome);
    add_controls(target, other_plan, frame, frames, outcome);
    scored.push_back(target);
    show_progress(sequence.name, static_cast<int>(scored.size()), frames);
  }
  tune_textbook(scored, options.seeds, outcome);
  outcome.tuned.name = fmt::format("textbook tuned ({})", outcome.tuned_weights);
  return outcome;
}

}  // namespace prostm::bench
