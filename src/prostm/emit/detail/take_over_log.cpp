#include "prostm/emit/detail/take_over_log.hpp"

namespace prostm {

TakeOverLog::TakeOverLog() : reports_(kReports) {}

void TakeOverLog::arrive(std::int64_t plan, double total_length, std::int64_t sample) noexcept {
  ++serial_;
  plan_ = plan;
  arrival_ = sample;
  total_length_ = total_length;
}

TakeOverLog::Entry TakeOverLog::follow(std::int64_t sample) noexcept {
  // the entry of the newest plan, or a free one; one is always free, since followers are fewer
  Entry entry = kNone;
  for (Entry i = 0; i < static_cast<Entry>(plans_.size()); ++i) {
    const Plan& plan = plans_[static_cast<std::size_t>(i)];
    if (plan.followers > 0 && plan.serial == serial_) {
      entry = i;
      break;
    }
    if (plan.followers == 0 && entry == kNone) entry = i;
  }
  Plan& plan = plans_[static_cast<std::size_t>(entry)];
  if (plan.followers == 0) {
    plan = {};
    plan.report = {plan_, arrival_, sample, -1};
    plan.serial = serial_;
    plan.length = total_length_;
  }
  ++plan.followers;
  return entry;
}

void TakeOverLog::draw(Entry entry, double length, std::int64_t sample) noexcept {
  Plan& plan = plans_[static_cast<std::size_t>(entry)];
  plan.drawn += length;
  if (plan.drawn >= kRedrawn * plan.length) report(plan, sample);
}

void TakeOverLog::leave(Entry entry) noexcept {
  if (entry == kNone) return;
  Plan& plan = plans_[static_cast<std::size_t>(entry)];
  if (--plan.followers == 0) report(plan, -1);
}

void TakeOverLog::report(Plan& plan, std::int64_t redrawn_sample) noexcept {
  if (plan.reported) return;
  plan.reported = true;
  plan.report.redrawn_sample = redrawn_sample;
  reports_.push(plan.report);
}

}  // namespace prostm
