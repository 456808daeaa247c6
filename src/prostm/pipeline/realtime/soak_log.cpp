#include "prostm/pipeline/realtime/soak_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace prostm {
namespace {

constexpr double kSettle = 1.0;    // settling time after a load, while the queue refills [s]
constexpr double kGap = 0.010;     // smallest gap reported, for a program that polls every 2 ms [s]
constexpr double kStolen = 0.004;  // smallest stolen processor time reported [s]
constexpr double kOthers = 0.2;    // smallest use by other programs reported [cores]

/// "late_blocks" in words.
std::string words_of(const char* name) {
  std::string words = name;
  std::ranges::replace(words, '_', ' ');
  return words;
}

}  // namespace

SoakLog::SoakLog(double seconds, bool load, int cores)
    : settle_(load ? std::min(kSettle, seconds / 20.0) : 0.0), cores_(cores) {
  const double third = seconds / 3.0;
  parts_[0] = {.to = third};
  parts_[1] = {.loaded = load, .from = third, .to = 2.0 * third + settle_};
  parts_[2] = {.from = 2.0 * third + settle_, .to = seconds};
}

int SoakLog::part_at(double time) const {
  return time < parts_[0].to ? 0 : time < parts_[1].to ? 1 : 2;
}

bool SoakLog::is_loaded_at(double time) const {
  return parts_[1].loaded && time >= parts_[1].from && time < parts_[1].to - settle_;
}

void SoakLog::count(double time, const SoakCounts& counts) {
  if (!counting_) {
    // the device started before the run
    counting_ = true;
    counts_ = counts;
    counted_at_ = time;
  }
  longest_gap_ = std::max(longest_gap_, time - counted_at_);
  counted_at_ = time;
  std::int64_t missed = 0;
  for (const Quantity<DeviceStats>& quantity : quantities<DeviceStats>()) {
    if (quantity.better != Better::Less) continue;
    const auto more = static_cast<std::int64_t>(value_of(quantity, counts.device) -
                                                value_of(quantity, counts_.device));
    // a missed block also counts as late
    const bool is_late = std::string_view(quantity.name) == "late_blocks";
    if (is_late) missed = counts.device.missed_blocks - counts_.device.missed_blocks;
    add(time, words_of(quantity.name), is_late && missed > 0 ? more - 1 : more, is_late);
  }
  add(time, "skipped steps", counts.skipped_steps - counts_.skipped_steps, false);
  add(time, "skipped plans", counts.skipped_plans - counts_.skipped_plans, false);
  add(time, "fades for lack of a plan", counts.stalls - counts_.stalls, false);
  if (!counts.problem.empty()) problem_ = counts.problem;
  add(time, "times that the device was lost", counts.gone - counts_.gone, false);
  add(time, "times too hot", counts.hot - counts_.hot, false);
  add(time, "samples outside the limits", counts.limited - counts_.limited, false);
  counts_ = counts;
}

void SoakLog::add(double time, const std::string& what, std::int64_t more, bool covered) {
  if (more <= 0) return;
  const int part = part_at(time);
  SoakPart& of = parts_[static_cast<std::size_t>(part)];
  (covered ? of.covered : of.dips) += more;
  open_.push_back({time, part, what, more, covered, {}});
}

void SoakLog::update(double due, std::int64_t step, std::int64_t updates, double work,
                     double step_time) {
  longest_work_ = std::max(longest_work_, work);
  step_time_ = step_time;
  const auto part = static_cast<std::size_t>(part_at(due));
  if (!begun_[part]) {
    begun_[part] = true;
    first_[part] = {due, step, updates};
  }
  const Mark& first = first_[part];
  const double span = due - first.due;
  if (span <= 0.0) return;
  parts_[part].world_rate = static_cast<double>(step - first.step) / span;
  parts_[part].plan_rate = static_cast<double>(updates - first.updates) / span;
}

void SoakLog::use(double time, const MachineUse& use) {
  for (SoakDip& dip : open_) {
    // limits are per part, so that the load cannot crowd out dips of quiet parts
    std::size_t& kept = kept_[static_cast<std::size_t>(dip.part)][dip.covered ? 1 : 0];
    if (kept >= kMostDips) {
      ++left_out_;
      continue;
    }
    ++kept;
    dip.cause = cause_of(dip, time - used_at_, use);
    dips_.push_back(std::move(dip));
  }
  open_.clear();
  use_ = use;
  used_at_ = time;
  forget_evidence();
}

void SoakLog::end(double time, const MachineUse& use) {
  this->use(time, use);
  auto& part = parts_[static_cast<std::size_t>(part_at(time))];
  // on a loaded machine the counters are sampled for the last time a little late
  part.to = std::max(std::min(part.to, time), counted_at_);
}

void SoakLog::forget_evidence() {
  longest_gap_ = longest_work_ = 0.0;
  problem_.clear();
}

/// @param seconds time since the previous use().
std::string SoakLog::cause_of(const SoakDip& dip, double seconds, const MachineUse& use) const {
  if (!problem_.empty()) return "the device: " + problem_;
  if (parts_[static_cast<std::size_t>(dip.part)].loaded) return "the load of this soak";
  const double stolen = use.stolen - use_.stolen,
               others = (use.busy - use_.busy - (use.own - use_.own)) / std::max(seconds, 1e-3);
  if (stolen >= kStolen) {
    return fmt::format("the host of this virtual machine took the processor for {:.0f} ms",
                       1e3 * stolen);
  }
  if (others >= kOthers) {
    return fmt::format("other programs took {:.1f} of {} cores", others, cores_);
  }
  if (use.faults > use_.faults) {
    return fmt::format("memory came back from a disk ({} page faults)", use.faults - use_.faults);
  }
  if (step_time_ > 0.0 && longest_work_ > step_time_) {
    return fmt::format("a step and its plan took {:.0f} ms", 1e3 * longest_work_);
  }
  if (longest_gap_ > kGap) {
    return fmt::format("the system kept the program waiting for {:.0f} ms", 1e3 * longest_gap_);
  }
  return "the system woke a thread late";
}

bool SoakLog::is_quiet_clean() const {
  return std::ranges::all_of(parts_,
                             [](const SoakPart& part) { return part.loaded || part.dips == 0; });
}

}  // namespace prostm
