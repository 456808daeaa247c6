#include "prostm/pipeline/latency.hpp"

#include <algorithm>

namespace prostm {

const char* latency_part_name(int part) {
  constexpr std::array<const char*, kLatencyParts> kNames = {
      "frame", "late", "hand",  "world", "contact", "hand_over",
      "plan",  "lift", "block", "lap",   "queue"};
  return kNames[static_cast<std::size_t>(part)];
}

void LatencyLog::plan(const WorldFrame& contact, const PlanFrame& plan, double run_start) noexcept {
  Plan& entry = plans_[static_cast<std::size_t>(plan.id) % plans_.size()];
  entry.arrival = run_start + contact.arrival;
  auto& part = entry.latency.part;
  part = {};
  part[kFrameWait] = std::max(0.0, contact.due - contact.arrival);
  part[kLateStart] = contact.taken - contact.arrival - part[kFrameWait];
  entry.submitted = run_start + contact.taken;
  if (!realtime_) return;

  part[kHandPart] = contact.track_time + contact.hand_time;
  part[kWorldPart] = contact.meet_time;
  part[kContactPart] = contact.contact_time;
  part[kHandOver] =
      plan.start - contact.taken - part[kHandPart] - part[kWorldPart] - part[kContactPart];
  part[kPlanPart] = plan.plan_time;
  part[kLiftPart] = plan.lift_time;
  entry.submitted = run_start + plan.start + plan.plan_time + plan.lift_time;
}

void LatencyLog::follow(const TakeOver& event, const Device& device) noexcept {
  const Plan& entry = plans_[static_cast<std::size_t>(event.plan) % plans_.size()];
  const int decimation = device.info().decimation;
  const double leaves = device.play_time(event.first_sample / decimation),
               asked = device.ask_time(event.first_sample / decimation),
               known = device.ask_time(event.arrival_sample / decimation);

  Latency latency = entry.latency;
  latency.part[kBlockWait] = known - entry.submitted;
  latency.part[kLapWait] = asked - known;
  latency.part[kQueuePart] = leaves - asked;
  latency.total = leaves - entry.arrival;
  total_.add(latency.total);
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].add(latency.part[i]);
  if (event.redrawn_sample >= 0) {
    redraw_.add(device.play_time(event.redrawn_sample / decimation) - entry.arrival);
  }
  last_ = latency;
}

}  // namespace prostm
