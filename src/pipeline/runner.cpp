#include "pipeline/runner.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <semaphore>
#include <thread>

#include "core/latest.hpp"
#include "core/spsc_ring.hpp"
#include "core/stage_timer.hpp"
#include "pipeline/run_log.hpp"
#include "pipeline/steering.hpp"

namespace prostm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLatestPrepare = 0.8;  // of a step, after which the next one is prepared anyway
constexpr std::chrono::microseconds kPoll{200};
constexpr std::chrono::milliseconds kPausePoll{4};

void sleep_until(double time) {
  std::this_thread::sleep_until(Clock::time_point(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time))));
}

/// One plan update as the observer sees it.
struct Update {
  ContactFrame contact;
  PlanFrame plan;
};

/// What the threads of one run share.
class Run {
 public:
  Run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
      RunObserver& observer)
      : pipeline_(pipeline),
        observer_(observer),
        realtime_(options.mode == RunMode::RealTime),
        prepare_early_(options.prepare_early),
        dt_(1.0 / settings.fluid_rate),
        steps_(std::llround(options.seconds * settings.fluid_rate)),
        frame_wait_(std::min(settings.frame_wait, 0.5 * dt_)),
        start_(realtime_ ? steady_now() : 0.0),
        stall_time_(settings.emit.stall_time),
        stay_(options.stay),
        plan_log_(realtime_) {
    if (options.live != nullptr) steering_.emplace(*options.live, pipeline);
  }

  void stepped() {
    for (std::int64_t n = 1; n <= steps_ && !stop_; ++n) {
      const bool planned = pipeline_.step(dt_);
      smoke_log_.meet(pipeline_.contact());
      smoke_log_.settle(pipeline_.smoke().fluid_stats());
      if (planned) {
        plan_log_.add(pipeline_.contact(), pipeline_.plan(), start_);
        follow();
        observe(pipeline_.contact(), pipeline_.plan());
      }
      progress(pipeline_.time());
    }
  }

  void threaded() {
    do {
      segment();
    } while (goes_on());
  }

  /// Of the whole run. Ends the output.
  RunSummary finish() {
    if (!summary_) summary_ = summary();
    pipeline_.device().stop();
    return *summary_;
  }

 private:
  RunSummary summary();

  // ---- segments: threads from one change that an onlooker asks for to the next ----

  void segment() {
    halt_ = smoke_ended_ = plan_ended_ = false;
    std::jthread smoke([this] { realtime_ ? smoke_in_real_time() : smoke_without_clock(); });
    std::jthread plan([this] { realtime_ ? plan_in_real_time() : plan_without_clock(); });
    while (!plan_ended_.load(std::memory_order_acquire)) {
      drain_updates();
      look();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    smoke.join();
    plan.join();
    drain_updates();
  }

  /// What is done while no other thread runs. False at the end.
  bool goes_on() {
    follow();
    if (!realtime_ || stop_ || (slot_ >= steps_ && !stay_)) return false;
    if (slot_ >= steps_ && !summary_) {
      summary_ = summary();
      summary_waits_ = true;
    }
    if (!steering_) {
      start_ = steady_now() - static_cast<double>(slot_) * dt_;
      return true;
    }
    steering_->attend();
    while (!steering_->playing() && !stop_) {
      if (steering_->next_update()) {
        one_update();
      } else {
        std::this_thread::sleep_for(kPausePoll);
      }
      look();
      progress(run_time_.load(std::memory_order_relaxed));
      if (steering_->pending()) steering_->attend();
    }
    // run time goes on from where it was
    start_ = steady_now() - static_cast<double>(slot_) * dt_;
    return !stop_;
  }

  /// Fluid steps up to the next plan update, on this thread.
  void one_update() {
    bool targeted = false;
    while (!targeted) {
      SmokeStage& smoke = pipeline_.smoke();
      smoke.prepare(dt_);
      ++slot_;
      const double time = static_cast<double>(slot_) * dt_;
      start_ = steady_now() - time;
      ContactFrame& frame = newest_.draft();
      smoke.take(time, frame);
      targeted = meet(time, frame);
      smoke.settle();
      settled(time);
    }
    ++published_;
    if (newest_.refresh()) plan_one(newest_.value());
    drain_updates();
  }

  /// For those who look, on the caller's thread.
  void look() {
    if (summary_waits_) observer_.on_summary(*summary_);
    summary_waits_ = false;
    if (!steering_) return;
    const double planned_at = planned_at_.load(std::memory_order_relaxed);
    steering_->show(run_time_.load(std::memory_order_relaxed),
                    steady_now() - planned_at > stall_time_);
    if (steering_->pending()) halt_ = true;
    // somebody who has just come sees the smoke of a run that is paused
    const bool watched = steering_->snapshots().watched();
    if (watched && !watched_ && !steering_->playing())
      steering_->snapshots().smoke(pipeline_.smoke().fluid());
    watched_ = watched;
  }

  // ---- real time: the newest target wins ----

  double run_time() const { return steady_now() - start_; }

  void smoke_in_real_time() {
    SmokeStage& smoke = pipeline_.smoke();
    while (!ended() && !stop_ && !halt_) {
      if (prepare_early_) smoke.prepare(dt_);
      ++slot_;
      sleep_until(start_ + static_cast<double>(slot_) * dt_);
      // more than a step behind: let steps go rather than run after the clock
      const auto due = static_cast<std::int64_t>(run_time() / dt_);
      if (due > slot_) {
        const std::int64_t last = stay_ ? due : std::min(due, steps_);
        smoke_log_.skip(last - slot_);
        slot_ = last;
      }
      const double begins = static_cast<double>(slot_) * dt_;  // run time
      ContactFrame& frame = newest_.draft();
      take_hands(begins, smoke.targets(smoke_log_.steps() + 1) ? frame_wait_ : 0.0, frame);
      if (!prepare_early_) smoke.prepare(dt_);
      const bool targeted = meet(begins, frame);
      if (targeted) {
        ++published_;
        ready_.release();
        // the planner gets the cores while it plans
        if (prepare_early_) wait_for_plan(smoke_log_.steps(), begins + kLatestPrepare * dt_);
      }
      smoke.settle();
      settled(begins);
    }
    smoke_ended_.store(true, std::memory_order_release);
    ready_.release();
  }

  /// Whether the run's seconds are over, or were in a segment before.
  bool ended() const { return slot_ >= steps_ && !summary_; }

  /// The hands of `frame`, newest_'s draft, meet the fluid; true when that made a target, which is
  /// published.
  bool meet(double due, ContactFrame& frame) {
    pipeline_.smoke().meet(smoke_log_.steps() + 1, due, dt_, frame);
    smoke_log_.meet(frame);
    if (steering_) steering_->snapshots().step(frame, pipeline_.smoke());
    const bool targeted = frame.targeted;
    if (targeted) newest_.publish();
    return targeted;
  }

  void settled(double time) {
    smoke_log_.settle(pipeline_.smoke().fluid_stats());
    if (steering_) steering_->snapshots().smoke(pipeline_.smoke().fluid());
    run_time_.store(time, std::memory_order_relaxed);
  }

  /// The hands for a step that is due, with a tracker's frame that came in since if one comes
  /// within `wait` [s].
  void take_hands(double due, double wait, ContactFrame& frame) {
    for (;;) {
      const double time = run_time();
      pipeline_.smoke().take(time, frame);
      if (frame.arrival >= due || time >= due + wait || stop_ || halt_) return;
      std::this_thread::sleep_for(kPoll);
    }
  }

  /// Until the plan of this step was handed over, or until a run time [s].
  void wait_for_plan(std::int64_t step, double latest) const {
    while (planned_step_.load(std::memory_order_acquire) < step && run_time() < latest) {
      std::this_thread::sleep_for(kPoll);
    }
  }

  void plan_in_real_time() {
    for (bool ended = false; !ended;) {
      ready_.acquire();
      while (ready_.try_acquire()) {  // targets that are overwritten by now
      }
      ended = smoke_ended_.load(std::memory_order_acquire);
      if (newest_.refresh()) plan_one(newest_.value());
    }
    plan_ended_.store(true, std::memory_order_release);
  }

  // ---- as fast as possible: plan k uses fluid step k · steps_per_plan, nothing is dropped
  // ----

  void smoke_without_clock() {
    for (std::int64_t n = 1; n <= steps_ && !stop_; ++n) {
      ContactFrame* frame = nullptr;
      while ((frame = targets_.back()) == nullptr && !stop_) std::this_thread::yield();
      if (frame == nullptr) break;
      time_ += dt_;
      pipeline_.smoke().run(n, time_, dt_, *frame);
      smoke_log_.meet(*frame);
      smoke_log_.settle(pipeline_.smoke().fluid_stats());
      if (frame->targeted) targets_.commit();
      run_time_.store(time_, std::memory_order_relaxed);
    }
    smoke_ended_.store(true, std::memory_order_release);
  }

  void plan_without_clock() {
    for (;;) {
      const bool last = smoke_ended_.load(std::memory_order_acquire);
      if (ContactFrame* frame = targets_.front()) {
        play_until(pipeline_.device(), frame->taken);
        plan_one(*frame);
        targets_.pop();
      } else if (last) {
        play_until(pipeline_.device(), run_time_.load(std::memory_order_relaxed));
        break;
      } else {
        std::this_thread::yield();
      }
    }
    plan_ended_.store(true, std::memory_order_release);
  }

  void plan_one(const ContactFrame& contact) {
    Update* update = updates_.back();
    while (update == nullptr && !realtime_ && !stop_) {
      std::this_thread::yield();
      update = updates_.back();
    }
    PlanFrame& frame = update != nullptr ? update->plan : spare_;
    const double start = realtime_ ? run_time() : contact.taken;
    pipeline_.plans().run(contact, frame);
    planned_step_.store(contact.step, std::memory_order_release);
    frame.start = start;
    plan_log_.add(contact, frame, start_);
    follow();
    if (frame.status == PlanStatus::Planned) planned_at_ = steady_now();
    if (steering_) steering_->snapshots().plan(contact, frame, plan_log_.latency().last_total());
    if (update != nullptr) {
      update->contact = contact;
      updates_.commit();
    } else {
      ++unobserved_;
    }
  }

  /// Takes in what became of the plans.
  void follow() { plan_log_.follow(pipeline_.plans().emitter(), pipeline_.device()); }

  // ---- the caller's thread ----

  void drain_updates() {
    while (Update* update = updates_.front()) {
      observe(update->contact, update->plan);
      updates_.pop();
    }
    progress(run_time_.load(std::memory_order_relaxed));
  }

  void observe(const ContactFrame& contact, const PlanFrame& plan) {
    if (!observer_.on_plan(contact, plan)) stop_ = true;
  }
  void progress(double time) {
    if (!observer_.on_progress(time)) stop_ = true;
  }

  Pipeline& pipeline_;
  RunObserver& observer_;
  const bool realtime_, prepare_early_;
  const double dt_;
  const std::int64_t steps_;
  const double frame_wait_;  // [s]
  double start_;             // what the clock shows at run time 0 [s]
  const double stall_time_;  // without a plan, after which output fades [s]
  const bool stay_;
  std::optional<Steering> steering_;
  std::optional<RunSummary> summary_;  // once the run's seconds are over
  bool summary_waits_ = false, watched_ = false;
  std::int64_t slot_ = 0;  // of the step before; the fluid's thread while it runs

  std::atomic<bool> halt_{false};        // ends the segment
  std::atomic<double> planned_at_{0.0};  // when the last plan was [s of the clock]
  std::atomic<bool> stop_{false}, smoke_ended_{false}, plan_ended_{false};
  std::atomic<double> run_time_{0.0};
  std::atomic<std::int64_t> planned_step_{0};  // of the last plan that was handed over
  Latest<ContactFrame> newest_;                // real time
  std::counting_semaphore<> ready_{0};
  SpscRing<ContactFrame> targets_{4};  // as fast as possible
  SpscRing<Update> updates_{64};
  PlanFrame spare_;
  SmokeLog smoke_log_;
  PlanLog plan_log_;
  std::int64_t published_ = 0, unobserved_ = 0;
  double time_ = 0.0;
};

RunSummary Run::summary() {
  RunSummary s;
  follow();
  smoke_log_.write(s);
  plan_log_.write(s);
  s.device = pipeline_.device_stats();
  s.emit = pipeline_.emit_stats();
  s.stopped = stop_;
  s.seconds = realtime_ ? run_time_.load() : static_cast<double>(s.fluid_steps) * dt_;
  if (realtime_) s.skipped_updates = published_ - s.plans - s.empty_updates;
  s.unobserved = unobserved_;
  s.full_scale_pressure = pipeline_.plans().full_scale_pressure();
  return s;
}

}  // namespace

RunSummary run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
               RunObserver& observer) {
  Run run(pipeline, settings, options, observer);
  if (options.mode == RunMode::Stepped) {
    run.stepped();
  } else {
    run.threaded();
  }
  return run.finish();
}

}  // namespace prostm
