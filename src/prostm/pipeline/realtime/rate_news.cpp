#include "prostm/pipeline/realtime/rate_news.hpp"

#include <fmt/format.h>

namespace prostm {

std::optional<std::string> RateNews::look(const WorldFrame& contact, const PlanFrame& plan,
                                          const PipelineSettings& settings) {
  const int steps_per_plan = settings.steps_per_plan();
  const Span anew{contact.due, steps_per_plan, contact.step, plan.id};
  // pauses do not count, since run time stands still; another method has other rates
  if (!span_ || span_->steps_per_plan != steps_per_plan) span_ = anew;
  if (!adviser_.is_for(settings)) advice_ = {};
  Span& span = *span_;
  ++span.updates;
  span.step_time += contact.track_time + contact.hand_time + contact.world_time +
                    contact.contact_time / steps_per_plan;
  span.plan_time += plan.plan_time + plan.lift_time;
  const double seconds = contact.due - span.begin;
  if (seconds < kOver) return {};

  const double due = settings.world_rate, plans_due = due / steps_per_plan;
  const double done = static_cast<double>(contact.step - span.steps) / seconds;
  const double plans_done = static_cast<double>(plan.id - span.plans) / seconds;
  const auto updates = static_cast<double>(span.updates);
  const WorkTime work{span.step_time / updates, span.plan_time / updates};
  span_ = anew;
  const bool missed = done < kHeld * due || plans_done < kHeld * plans_due;
  // other settings may lead to other advice
  const bool advised = advice_.kind != AdviceKind::None;
  if (missed == missed_ && missed == advised) return {};
  missed_ = missed;
  advice_ = missed ? adviser_.advise(work, settings) : Advice{};
  if (!missed) return "The rates are held again.";
  return fmt::format(
      "The rates are not held: smoke {:.1f} of {:.0f} Hz, plans {:.1f} of {:.0f} Hz. {}", done, due,
      plans_done, plans_due, sentence(advice_, settings));
}

}  // namespace prostm
