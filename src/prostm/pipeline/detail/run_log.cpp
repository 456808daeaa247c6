#include "prostm/pipeline/detail/run_log.hpp"

#include <algorithm>

namespace prostm {

void SmokeLog::meet(const ContactFrame& frame) {
  ++steps_;
  track_.add(frame.track_time);
  hand_.add(frame.hand_time);
  fluid_.add(frame.fluid_time);
  if (!frame.targeted) return;
  contact_.add(frame.contact_time);
  joints_outside_ += frame.contact.joints_outside;
  skin_cells_ += frame.contact.skin_cells;
  steep_cells_ += frame.contact.steep_cells;
}

void SmokeLog::settle(const FluidStats& stats) {
  resets_ += stats.reset ? 1 : 0;
  divergence_ += stats.divergence_rms;
}

void SmokeLog::write(RunSummary& out) const {
  out.fluid_steps = steps_;
  out.skipped_fluid_steps = skipped_;
  out.fluid_resets = resets_;
  out.joints_outside = joints_outside_;
  out.skin_cells = skin_cells_;
  out.steep_cells = steep_cells_;
  out.mean_divergence = steps_ > 0 ? divergence_ / static_cast<double>(steps_) : 0.0;
  out.track = track_.summary();
  out.hand = hand_.summary();
  out.fluid = fluid_.summary();
  out.contact = contact_.summary();
}

void PlanLog::add(const ContactFrame& contact, const PlanFrame& frame, double run_start) {
  latency_.plan(contact, frame, run_start);
  plan_.add(frame.stats.total);
  lift_.add(frame.lift_time);
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
  out.max_path_length = max_path_length_;
  out.max_skin_length = max_skin_length_;
  out.plan = plan_.summary();
  out.lift = lift_.summary();
  out.latency = latency_.total();
  out.redraw = latency_.redraw();
  for (int part = 0; part < kLatencyParts; ++part) {
    out.latency_parts[static_cast<std::size_t>(part)] = latency_.part(part);
  }
}

}  // namespace prostm
