#include "prostm/pipeline/detail/run_sides.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "prostm/core/stage_timer.hpp"

namespace prostm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMostBehind = 3.0;     // largest delay that is caught up [steps]
constexpr double kLatestPrepare = 0.8;  // of a step: longest wait for the plan
constexpr std::chrono::microseconds kPoll{200};

void sleep_until(double time) {
  std::this_thread::sleep_until(Clock::time_point(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time))));
}

}  // namespace

RunPace::RunPace(const PipelineSettings& settings, const RunOptions& options)
    : realtime(options.mode == RunMode::RealTime),
      prepare_early(options.prepare_early),
      stay(options.stay),
      dt(1.0 / settings.world_rate),
      steps(std::llround(options.seconds * settings.world_rate)),
      frame_wait(std::min(settings.frame_wait, 0.5 * dt)) {}

// ---- the world ----

void WorldSide::run() noexcept {
  shared_.end.guard([this] { pace_.realtime ? in_real_time() : without_clock(); });
  shared_.world_ended.store(true, std::memory_order_release);
  shared_.ready.release();
}

void WorldSide::count(const WorldFrame& frame) {
  log_.meet(frame);
  log_.settle(pipeline_.world_stage());
}

/// A segment ends with a complete update, so that a paused run can advance by complete updates.
bool WorldSide::goes_on() const {
  if (shared_.end.over() || (done() && !shared_.endless)) return false;
  return !(shared_.halt && pipeline_.world_stage().targets(log_.steps()));
}

double WorldSide::run_time() const {
  return steady_now() - shared_.start;
}

void WorldSide::set_clock() {
  shared_.start = steady_now() - time();
}

/// Steps in real time; a new target replaces one that is not yet planned.
void WorldSide::in_real_time() {
  WorldStage& stage = pipeline_.world_stage();
  double behind_before = 0.0;  // steps
  while (goes_on()) {
    if (pace_.prepare_early) stage.prepare(pace_.dt);
    ++slot_;
    sleep_until(shared_.start + time());
    // catch up on a delay as long as each step begins less late than the one before; otherwise skip
    // steps
    const double behind = run_time() / pace_.dt - static_cast<double>(slot_);
    if (behind >= kMostBehind ||
        (behind >= 1.0 && behind_before >= 1.0 && behind >= behind_before)) {
      const std::int64_t due = slot_ + static_cast<std::int64_t>(behind);
      const std::int64_t last = pace_.stay ? due : std::min(due, pace_.steps);
      log_.skip(last - slot_);
      slot_ = last;
    }
    behind_before = behind;
    const double begins = time();
    WorldFrame& frame = shared_.newest.draft();
    take_hands(begins, stage.targets(log_.steps() + 1) ? pace_.frame_wait : 0.0, frame);
    if (!pace_.prepare_early) stage.prepare(pace_.dt);
    const bool targeted = meet(begins, frame);
    if (targeted) {
      shared_.ready.release();
      // the planner gets the cores while it plans
      if (pace_.prepare_early) wait_for_plan(log_.steps(), begins + kLatestPrepare * pace_.dt);
    }
    stage.settle();
    settled(begins);
  }
}

/// Lets the hands of `frame`, the draft of `newest`, meet the world. Returns true if this made a
/// target, which is then published.
bool WorldSide::meet(double due, WorldFrame& frame) {
  pipeline_.world_stage().meet(log_.steps() + 1, due, pace_.dt, frame);
  log_.meet(frame);
  if (shared_.snapshots != nullptr) shared_.snapshots->step(frame, pipeline_.world_stage());
  const bool targeted = frame.targeted;
  if (targeted) {
    shared_.newest.publish();
    ++published_;
  }
  return targeted;
}

void WorldSide::settled(double time) {
  log_.settle(pipeline_.world_stage());
  if (shared_.snapshots != nullptr) shared_.snapshots->volume(pipeline_.world_stage().world());
  shared_.steps.store(log_.steps(), std::memory_order_relaxed);
  shared_.run_time.store(time, std::memory_order_relaxed);
}

/// Takes the hands for a step that is due, waiting up to `wait` [s] for a tracker's frame that
/// arrives after it was due.
void WorldSide::take_hands(double due, double wait, WorldFrame& frame) {
  for (;;) {
    const double time = run_time();
    pipeline_.world_stage().take(time, frame);
    if (frame.arrival >= due || time >= due + wait || shared_.end.over() || shared_.halt) return;
    std::this_thread::sleep_for(kPoll);
  }
}

/// Waits until the plan of this step is submitted, but at most until run time `latest` [s].
void WorldSide::wait_for_plan(std::int64_t step, double latest) const {
  while (shared_.planned_step.load(std::memory_order_acquire) < step && run_time() < latest)
    std::this_thread::sleep_for(kPoll);
}

void WorldSide::run_to_target() {
  WorldStage& stage = pipeline_.world_stage();
  for (bool targeted = false; !targeted;) {
    stage.prepare(pace_.dt);
    ++slot_;
    set_clock();
    WorldFrame& frame = shared_.newest.draft();
    stage.take(time(), frame);
    targeted = meet(time(), frame);
    stage.settle();
    settled(time());
  }
}

/// Steps without a clock: plan k uses step k · steps_per_plan, and nothing is dropped.
void WorldSide::without_clock() {
  double time = 0.0;
  for (std::int64_t n = 1; n <= pace_.steps && !shared_.end.over(); ++n) {
    WorldFrame* frame = nullptr;
    while ((frame = shared_.targets.back()) == nullptr && !shared_.end.over())
      std::this_thread::yield();
    if (frame == nullptr) break;
    time += pace_.dt;
    pipeline_.world_stage().run(n, time, pace_.dt, *frame);
    count(*frame);
    if (frame->targeted) shared_.targets.commit();
    shared_.run_time.store(time, std::memory_order_relaxed);
  }
}

// ---- the planner ----

void PlanSide::run() noexcept {
  shared_.end.guard([this] { pace_.realtime ? in_real_time() : without_clock(); });
  shared_.plan_ended.store(true, std::memory_order_release);
}

void PlanSide::in_real_time() {
  for (bool ended = false; !ended;) {
    shared_.ready.acquire();
    while (shared_.ready.try_acquire()) {  // skip signals of overwritten targets
    }
    ended = shared_.world_ended.load(std::memory_order_acquire);
    plan_newest();
  }
}

void PlanSide::without_clock() {
  // targets made before the run was stopped are still planned
  while (!shared_.end.failed()) {
    const bool last = shared_.world_ended.load(std::memory_order_acquire);
    if (WorldFrame* frame = shared_.targets.front()) {
      play_until(pipeline_.device(), frame->taken);
      plan(*frame);
      shared_.targets.pop();
    } else if (last) {
      play_until(pipeline_.device(), shared_.run_time.load(std::memory_order_relaxed));
      break;
    } else {
      std::this_thread::yield();
    }
  }
}

void PlanSide::plan_newest() {
  if (shared_.newest.refresh()) plan(shared_.newest.value());
}

void PlanSide::plan(const WorldFrame& contact) {
  Update* update = shared_.updates.back();
  while (update == nullptr && !pace_.realtime && !shared_.end.over()) {
    std::this_thread::yield();
    update = shared_.updates.back();
  }
  PlanFrame& frame = update != nullptr ? update->plan : spare_;
  const double start = pace_.realtime ? steady_now() - shared_.start : contact.taken;
  pipeline_.plans().run(contact, frame);
  shared_.planned_step.store(contact.step, std::memory_order_release);
  frame.start = start;
  count(contact, frame);
  if (frame.status == PlanStatus::Planned) shared_.planned_at = steady_now();
  if (shared_.snapshots != nullptr)
    shared_.snapshots->plan(contact, frame, log_.latency().last_total());
  if (update != nullptr) {
    update->contact = contact;
    shared_.updates.commit();
  } else {
    ++unobserved_;
  }
}

void PlanSide::count(const WorldFrame& contact, const PlanFrame& frame) {
  log_.add(contact, frame, shared_.start);
  follow();
  shared_.plans.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace prostm
