#include "pipeline/runner.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <semaphore>
#include <thread>

#include "core/latest.hpp"
#include "core/spsc_ring.hpp"

namespace prostm {
namespace {

using Clock = std::chrono::steady_clock;

double now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

void sleep_until(double time) {
  std::this_thread::sleep_until(Clock::time_point(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time))));
}

/// One plan update as the observer sees it.
struct Update {
  ContactFrame contact;
  PlanFrame plan;
};

/// Counts what the smoke stage did; used by its thread alone until that has ended.
struct SmokeLog {
  std::int64_t steps = 0, skipped = 0, resets = 0, joints_outside = 0;
  double divergence = 0.0;
  Distribution track, hand, fluid, contact;

  void add(const ContactFrame& frame) {
    ++steps;
    resets += frame.fluid.reset ? 1 : 0;
    divergence += frame.fluid.divergence_rms;
    track.add(frame.track_time);
    hand.add(frame.hand_time);
    fluid.add(frame.fluid_time);
    if (!frame.targeted) return;
    contact.add(frame.contact_time);
    joints_outside += frame.contact.joints_outside;
  }
};

/// Counts what the plan stage did, and follows plans to the device; used by its thread alone until
/// that has ended.
struct PlanLog {
  std::int64_t plans = 0, empty = 0, long_paths = 0, crossings = 0;
  double max_path_length = 0.0, max_skin_length = 0.0;
  Distribution plan, lift, latency, redraw;

  void add(const ContactFrame& contact, const PlanFrame& frame) {
    arrivals_[static_cast<std::size_t>(frame.id) % arrivals_.size()] = contact.arrival;
    plan.add(frame.stats.total);
    lift.add(frame.lift_time);
    if (frame.status != PlanStatus::Planned) {
      ++empty;
      return;
    }
    ++plans;
    long_paths += frame.stats.long_paths;
    crossings += frame.stats.crossings;
    max_skin_length = std::max(max_skin_length, frame.max_skin_length);
    for (const FocalPath& path : frame.plan.paths)
      max_path_length = std::max(max_path_length, path.length);
  }

  /// From a hand's arrival to the first sample planned from it, and to when 90 % of the new field
  /// was drawn.
  void follow(Emitter& emitter, const SimulatedArray& device, bool realtime) {
    const auto leaves = [&](std::int64_t sample) {
      return realtime ? device.play_time(sample)
                      : static_cast<double>(sample) / device.info().sample_rate;
    };
    TakeOver event;
    while (emitter.next_take_over(event)) {
      const double arrival = arrivals_[static_cast<std::size_t>(event.plan) % arrivals_.size()];
      latency.add(leaves(event.first_sample) - arrival);
      if (event.redrawn_sample >= 0) redraw.add(leaves(event.redrawn_sample) - arrival);
    }
  }

 private:
  std::array<double, 256>
      arrivals_{};  // by plan id; a plan is taken over within a few updates or never
};

/// What the threads of one run share.
class Run {
 public:
  Run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
      RunObserver& observer)
      : pipeline_(pipeline),
        observer_(observer),
        realtime_(options.mode == RunMode::RealTime),
        dt_(1.0 / settings.fluid_rate),
        steps_(std::llround(options.seconds * settings.fluid_rate)) {}

  void stepped() {
    for (std::int64_t n = 1; n <= steps_ && !stop_; ++n) {
      const bool planned = pipeline_.step(dt_);
      smoke_log_.add(pipeline_.contact());
      if (planned) {
        plan_log_.add(pipeline_.contact(), pipeline_.plan());
        plan_log_.follow(pipeline_.plans().emitter(), pipeline_.device(), false);
        observe(pipeline_.contact(), pipeline_.plan());
      }
      progress(pipeline_.time());
    }
  }

  void threaded() {
    std::jthread smoke([this] { realtime_ ? smoke_in_real_time() : smoke_without_clock(); });
    std::jthread plan([this] { realtime_ ? plan_in_real_time() : plan_without_clock(); });
    while (!plan_ended_.load(std::memory_order_acquire)) {
      drain_updates();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    smoke.join();
    plan.join();
    drain_updates();
  }

  RunSummary summary();

 private:
  // ---- real time: the newest target wins ----

  void smoke_in_real_time() {
    const double start = now();
    std::int64_t slot = 0;
    while (slot < steps_ && !stop_) {
      ++slot;
      sleep_until(start + static_cast<double>(slot) * dt_);
      // more than a step behind: let steps go rather than run after the clock
      const auto due = static_cast<std::int64_t>((now() - start) / dt_);
      if (due > slot) {
        smoke_log_.skipped += std::min(due, steps_) - slot;
        slot = std::min(due, steps_);
      }
      ContactFrame& frame = newest_.draft();
      const double arrival = now();
      pipeline_.smoke().run(smoke_log_.steps + 1, static_cast<double>(slot) * dt_, dt_, frame);
      frame.arrival = arrival;
      smoke_log_.add(frame);
      if (frame.targeted) {
        newest_.publish();
        ++published_;
        ready_.release();
      }
      run_time_.store(static_cast<double>(slot) * dt_, std::memory_order_relaxed);
    }
    smoke_ended_.store(true, std::memory_order_release);
    ready_.release();
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
      smoke_log_.add(*frame);
      if (frame->targeted) targets_.commit();
      run_time_.store(time_, std::memory_order_relaxed);
    }
    smoke_ended_.store(true, std::memory_order_release);
  }

  void plan_without_clock() {
    for (;;) {
      const bool last = smoke_ended_.load(std::memory_order_acquire);
      if (ContactFrame* frame = targets_.front()) {
        play_until(pipeline_.device(), frame->arrival);
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
    pipeline_.plans().run(contact, frame);
    plan_log_.add(contact, frame);
    plan_log_.follow(pipeline_.plans().emitter(), pipeline_.device(), realtime_);
    if (update != nullptr) {
      update->contact = contact;
      updates_.commit();
    } else {
      ++unobserved_;
    }
  }

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
  const bool realtime_;
  const double dt_;
  const std::int64_t steps_;

  std::atomic<bool> stop_{false}, smoke_ended_{false}, plan_ended_{false};
  std::atomic<double> run_time_{0.0};
  Latest<ContactFrame> newest_;  // real time
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
  SimulatedArray& device = pipeline_.device();
  plan_log_.follow(pipeline_.plans().emitter(), device, realtime_);
  s.device = device.stats();
  device.stop();
  s.emit = pipeline_.plans().emitter().stats();
  s.stopped = stop_;
  s.seconds = realtime_ ? run_time_.load() : static_cast<double>(smoke_log_.steps) * dt_;
  s.fluid_steps = smoke_log_.steps;
  s.skipped_fluid_steps = smoke_log_.skipped;
  s.fluid_resets = smoke_log_.resets;
  s.joints_outside = smoke_log_.joints_outside;
  s.mean_divergence =
      smoke_log_.steps > 0 ? smoke_log_.divergence / static_cast<double>(smoke_log_.steps) : 0.0;
  s.plans = plan_log_.plans;
  s.empty_updates = plan_log_.empty;
  if (realtime_) s.skipped_updates = published_ - s.plans - s.empty_updates;
  s.unobserved = unobserved_;
  s.long_paths = plan_log_.long_paths;
  s.crossings = plan_log_.crossings;
  s.max_path_length = plan_log_.max_path_length;
  s.max_skin_length = plan_log_.max_skin_length;
  s.full_scale_pressure = pipeline_.plans().full_scale_pressure();
  s.latency = plan_log_.latency.summary();
  s.redraw = plan_log_.redraw.summary();
  s.track = smoke_log_.track.summary();
  s.hand = smoke_log_.hand.summary();
  s.fluid = smoke_log_.fluid.summary();
  s.contact = smoke_log_.contact.summary();
  s.plan = plan_log_.plan.summary();
  s.lift = plan_log_.lift.summary();
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
  return run.summary();
}

}  // namespace prostm
