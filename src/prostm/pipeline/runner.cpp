#include "prostm/pipeline/runner.hpp"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

#include "prostm/core/stage_timer.hpp"
#include "prostm/pipeline/detail/run_sides.hpp"
#include "prostm/pipeline/detail/steering.hpp"
#include "prostm/pipeline/realtime/rate_news.hpp"

namespace prostm {
namespace {

constexpr std::chrono::milliseconds kLook{2}, kPausePoll{4};

/// A run, on the thread that called run().
class Run {
 public:
  Run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
      RunObserver& observer)
      : pipeline_(pipeline),
        observer_(observer),
        pace_(settings, options),
        mode_(options.mode),
        pause_kept_(options.pause_kept),
        stall_time_(settings.emit.stall_time),
        world_(pipeline, pace_, shared_),
        plans_(pipeline, pace_, shared_) {
    if (pace_.realtime) world_.set_clock();
    if (options.live == nullptr) return;
    page_hand_ = options.live->page_hand;
    steering_.emplace(*options.live, pipeline);
    shared_.snapshots = &steering_->snapshots();
  }

  void stepped() {
    shared_.end.guard([this] {
      for (std::int64_t n = 1; n <= pace_.steps && !over(); ++n) {
        const bool planned = pipeline_.step(pace_.dt);
        world_.count(pipeline_.contact());
        if (planned) {
          plans_.count(pipeline_.contact(), pipeline_.plan());
          observe(pipeline_.contact(), pipeline_.plan());
        }
        check_device();
        progress(pipeline_.time());
      }
    });
  }

  void threaded() {
    shared_.end.guard([this] {
      do {
        segment();
      } while (goes_on());
    });
  }

  /// Ends the output. Returns the summary of the whole run.
  RunSummary finish() {
    shared_.end.guard([this] {
      if (!summary_) summary_ = summary();
    });
    if (!summary_) summary_.emplace();
    pipeline_.silence();
    summary_->failure = shared_.end.failure();
    return *summary_;
  }

 private:
  RunSummary summary();
  void segment();
  bool goes_on();
  void wait_while_paused();
  void publish();
  void watch_pause(bool watched);

  bool over() const { return shared_.end.over(); }
  /// Starts the final fade without waiting for the threads to end.
  void mute_if_over() {
    if (pace_.realtime && over()) pipeline_.mute_for_good();
  }

  void drain_updates() {
    while (Update* update = shared_.updates.front()) {
      observe(update->contact, update->plan);
      shared_.updates.pop();
    }
    progress(shared_.run_time.load(std::memory_order_relaxed));
  }
  void observe(const WorldFrame& contact, const PlanFrame& plan) {
    if (pace_.realtime) {
      const auto news = rates_.look(contact, plan, pipeline_.settings());
      if (news) observer_.on_rates(*news);
    }
    if (!observer_.on_plan(contact, plan)) shared_.end.stop();
  }
  void progress(double time) {
    if (!observer_.on_progress(time)) shared_.end.stop();
  }
  void check_device() const {
    const Device& device = pipeline_.device();
    if (device.info().comes_back) return;
    if (device.status() == DeviceStatus::Vanished) throw std::runtime_error(device.problem());
  }

  Pipeline& pipeline_;
  RunObserver& observer_;
  const RunPace pace_;
  const RunMode mode_;
  const StageTimer since_start_;
  const double pause_kept_, stall_time_;  // [s]
  RunShared shared_;
  WorldSide world_;
  PlanSide plans_;
  std::optional<Steering> steering_;
  std::shared_ptr<const PageHand> page_hand_;  // null if there are no pages
  RateNews rates_;
  std::optional<RunSummary> summary_;  // set once the run's seconds are over
  bool summary_waits_ = false, watched_ = false;
  double alone_since_ = 0.0;  // while paused: time at which a viewer was last seen [s of the clock]
};

/// Runs the threads until the next change requested by a viewer.
void Run::segment() {
  shared_.halt = shared_.world_ended = shared_.plan_ended = false;
  std::jthread world, plans;
  // a failure here asks the threads to end before they are joined
  shared_.end.guard([&] {
    world = std::jthread([this] { world_.run(); });
    plans = std::jthread([this] { plans_.run(); });
    while (!shared_.plan_ended.load(std::memory_order_acquire)) {
      drain_updates();
      check_device();
      pipeline_.watch_heat(steady_now());
      publish();
      mute_if_over();
      std::this_thread::sleep_for(kLook);
    }
  });
  mute_if_over();
  if (world.joinable()) world.join();
  if (plans.joinable()) plans.join();
  if (!shared_.end.failed()) drain_updates();
}

/// Does the work between segments, while no other thread runs. Returns false at the end.
bool Run::goes_on() {
  plans_.follow();
  if (!pace_.realtime || over() || (world_.done() && !pace_.stay)) return false;
  if (world_.done() && !summary_) {
    summary_ = summary();
    summary_waits_ = shared_.endless = true;
  }
  if (steering_) {
    steering_->attend();
    wait_while_paused();
  }
  world_.set_clock();
  return !over();
}

/// Waits while the run is paused.
void Run::wait_while_paused() {
  alone_since_ = steady_now();
  while (!steering_->playing() && !over()) {
    if (steering_->next_update()) {
      world_.run_to_target();
      plans_.plan_newest();
      drain_updates();
    } else {
      std::this_thread::sleep_for(kPausePoll);
    }
    check_device();
    pipeline_.watch_heat(steady_now());
    publish();
    progress(shared_.run_time.load(std::memory_order_relaxed));
    if (steering_->pending()) steering_->attend();
  }
}

/// Publishes the state for viewers and the observer.
void Run::publish() {
  if (summary_waits_) observer_.on_summary(*summary_);
  summary_waits_ = false;
  if (!steering_) return;
  const double planned_at = shared_.planned_at.load(std::memory_order_relaxed);
  steering_->show(shared_.run_time.load(std::memory_order_relaxed),
                  shared_.steps.load(std::memory_order_relaxed),
                  shared_.plans.load(std::memory_order_relaxed),
                  steady_now() - planned_at > stall_time_, rates_.advice());
  if (steering_->pending()) shared_.halt = true;
  const bool watched = steering_->snapshots().watched();
  if (!steering_->playing()) watch_pause(watched);
  watched_ = watched;
}

/// Handles viewers of a paused run: a new viewer gets the smoke, and without viewers the run
/// resumes after a while.
void Run::watch_pause(bool watched) {
  if (watched && !watched_) steering_->snapshots().volume(pipeline_.world_stage().world());
  const double now = steady_now();
  if (watched) alone_since_ = now;
  if (now - alone_since_ < pause_kept_) return;
  steering_->play();
  observer_.on_abandoned_pause(world_.time());
}

RunSummary Run::summary() {
  RunSummary s;
  s.mode = mode_;
  s.took = since_start_.seconds();
  plans_.follow();
  s.world_quantities = pipeline_.world_stage().world().quantities();
  world_.log().write(s);
  plans_.log().write(s);
  s.played_by = pipeline_.device().info();
  s.device = pipeline_.device_stats();
  s.emit = pipeline_.emit_stats();
  s.safety = pipeline_.safety_stats();
  s.limited_samples = erred_samples(s.safety);
  s.stopped = over();
  s.seconds =
      pace_.realtime ? shared_.run_time.load() : static_cast<double>(s.world_steps) * pace_.dt;
  if (pace_.realtime) s.skipped_updates = world_.published() - s.plans - s.empty_updates;
  s.unobserved = plans_.unobserved();
  s.adviser = rates_.adviser();
  s.full_scale_pressure = pipeline_.plans().full_scale_pressure();
  if (page_hand_) {
    const PageHandReport hand = page_hand_->report();
    s.late_page_hands = hand.late;
    s.hidden_page_hands = hand.hidden;
  }
  return s;
}

}  // namespace

std::string mode_problem(const DeviceInfo& device, RunMode mode) {
  if (!device.keeps_time || mode == RunMode::RealTime) return {};
  return " keeps its own time, so it needs a run in real time, without --as-fast-as-possible and "
         "--stepped";
}

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
