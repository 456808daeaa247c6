#include "prostm/pipeline/detail/run_log.hpp"

#include <algorithm>

namespace prostm {

void WorldLog::meet(const WorldFrame& frame) {
  ++steps_;
  track_.add(frame.track_time);
  hand_.add(frame.hand_time);
  world_.add(frame.world_time);
  if (!frame.targeted) return;
  contact_.add(frame.contact_time);
  merge(frame.contact_stats, contact_stats_);
}

void WorldLog::settle(const WorldStage& stage) {
  const WorldStats& stats = stage.world_stats();
  const std::span<const WorldQuantity> quantities = stage.world().quantities();
  resets_ += stats.reset ? 1 : 0;
  if (quantities.data() != quantities_.data()) {
    quantities_ = quantities;
    values_ = {};
    before_ = steps_ - 1;
  }
  for (std::size_t q = 0; q < quantities_.size(); ++q) values_[q] += stats.values[q];
}

void WorldLog::write(RunSummary& out) const {
  out.world_steps = steps_;
  out.skipped_world_steps = skipped_;
  out.world_resets = resets_;
  out.contact_stats = contact_stats_;
  if (steps_ > 0) out.world_quantities = quantities_;
  const auto steps = static_cast<double>(std::max<std::int64_t>(1, steps_ - before_));
  for (std::size_t q = 0; q < quantities_.size(); ++q) out.world_means[q] = values_[q] / steps;
  out.track = track_.summary();
  out.hand = hand_.summary();
  out.world = world_.summary();
  out.contact = contact_.summary();
}

void PlanLog::add(const WorldFrame& contact, const PlanFrame& frame, double run_start) {
  latency_.plan(contact, frame, run_start);
  plan_.add(frame.stats.total);
  lift_.add(frame.lift_time);
  if (frame.gate) judge(contact.due, *frame.gate);
  if (frame.status != PlanStatus::Planned) {
    ++empty_;
    return;
  }
  ++plans_;
  long_paths_ += frame.stats.long_paths;
  crossings_ += frame.stats.crossings;
  max_skin_length_ = std::max(max_skin_length_, frame.max_skin_length);
  for (const FocalPath& path : frame.plan.paths) {
    max_path_length_ = std::max(max_path_length_, path.length);
  }
  for (const PlayedPath& path : frame.played.paths) {
    if (path.laps == 0) continue;
    lap_.add(path.period);
    focus_speed_.add(path.speed);
  }
}

void PlanLog::judge(double time, const GateResult& gate) {
  ++judged_;
  passed_ += gate.pass ? 1 : 0;
  if (!is_held(gate)) {
    held_since_.reset();
    return;
  }
  if (!held_since_) held_since_ = time;
  if (time - *held_since_ < RunSummary::kSettled) return;
  ++held_;
  held_passed_ += gate.pass ? 1 : 0;
  if (!gate.pass) ++held_problems_[static_cast<std::size_t>(gate.finding.problem)];
}

void PlanLog::follow(Emitter& emitter, const Device& device) {
  TakeOver event;
  while (emitter.next_take_over(event)) latency_.follow(event, device);
}

void PlanLog::write(RunSummary& out) const {
  out.plans = plans_;
  out.empty_updates = empty_;
  out.long_paths = long_paths_;
  out.crossings = crossings_;
  out.judged_updates = judged_;
  out.passed_updates = passed_;
  out.held_updates = held_;
  out.held_passed_updates = held_passed_;
  // a frame without a fault of its own fails because of those of the second before
  const auto of_field = held_problems_.begin() + static_cast<std::ptrdiff_t>(GateProblem::Maxima);
  const auto most = std::max_element(of_field, held_problems_.end());
  if (*most > 0) out.held_problem = static_cast<GateProblem>(most - held_problems_.begin());
  out.max_path_length = max_path_length_;
  out.max_skin_length = max_skin_length_;
  out.plan = plan_.summary();
  out.lift = lift_.summary();
  out.lap = lap_.summary();
  out.focus_speed = focus_speed_.summary();
  out.latency = latency_.total();
  out.redraw = latency_.redraw();
  for (int part = 0; part < kLatencyParts; ++part) {
    out.latency_parts[static_cast<std::size_t>(part)] = latency_.part(part);
  }
}

}  // namespace prostm
