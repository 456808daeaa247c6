#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/track/live/tracker_news.hpp"
#include "run/instant.hpp"
#include "run/mute_watch.hpp"
#include "run/run_quality.hpp"
#include "run/run_summary.hpp"
#include "run/view.hpp"

namespace prostm::app {
namespace {

constexpr double kTrackerLook = 0.1;  // [s]
constexpr double kLeastFelt = 5.0;    // shortest run whose percept is computed [s]

/// Records, stores the instant for the picture, and stops the run on a signal or if the page's
/// server fails.
class Observer final : public RunObserver {
 public:
  /// @param picture_at time of the picture [s]; nothing without a picture.
  Observer(Recorder* recorder, const View* view, std::optional<double> picture_at,
           const RunOptions& options, std::FILE* out)
      : recorder_(recorder), view_(view), picture_at_(picture_at), options_(options), out_(out) {}

  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    if (recorder_ != nullptr) {
      const bool planned = plan.status == PlanStatus::Planned;
      const RecordedPlan made{plan.plan, plan.stats, plan.full_scale_pressure, plan.sigma};
      recorder_->append(contact.target, contact.hands, planned ? &made : nullptr, plan.gate);
    }
    if (plan.status == PlanStatus::Planned) sample_.offer(contact, plan);
    if (picture_at_ && plan.status == PlanStatus::Planned) {
      const double away = std::abs(contact.target.time - *picture_at_);
      if (away < away_) {
        away_ = away;
        contact_ = contact;
        plan_ = plan;
      }
    }
    return !interrupt_.requested();
  }

  bool on_progress(double time) override {
    say_whether_muted();
    say_news_of_tracker();
    say_news_of_array();
    if (view_ != nullptr) view_->check();
    if (!reported_) progress_.show(time, options_.seconds, "s");
    return !interrupt_.requested();
  }

  void on_summary(const RunSummary& summary) override {
    reported_ = true;
    recorder_ = nullptr;
    picture_at_.reset();
    progress_.clear();
    report_(summary);
  }
  void on_rates(const std::string& news) override { progress_.say(out_, news); }
  void on_abandoned_pause(double time) override {
    progress_.say(
        out_, fmt::format("No page is connected any more, so the paused run resumes, {}.",
                          options_.stay ? "until Ctrl-C"
                                        : fmt::format("for {:.1f} s", options_.seconds - time)));
  }
  /// Reports when the array is muted or unmuted; in real time the terminal's keys mute it.
  void follow(std::shared_ptr<Mute> mute) {
    mutes_.emplace(std::move(mute), options_.mode == RunMode::RealTime);
    if (const auto help = mutes_->help()) progress_.say(out_, *help);
  }
  /// Reports changes of the array's and a live tracker's connection.
  void follow(Pipeline& pipeline) { pipeline_ = &pipeline; }
  /// Sets the function to call when the run's seconds are over but it continues.
  void on_report(std::function<void(const RunSummary&)> report) { report_ = std::move(report); }
  bool reported() const { return reported_; }
  /// Ends the output of this observer.
  void end() {
    mutes_.reset();
    progress_.clear();
  }

  const Interrupt& interrupt() const { return interrupt_; }
  bool has_instant() const { return std::isfinite(away_); }
  const WorldFrame& contact() const { return contact_; }
  const PlanFrame& plan() const { return plan_; }
  const PlanSample& sample() const { return sample_; }

 private:
  void say_whether_muted() {
    if (!mutes_) return;
    while (const auto news = mutes_->look()) progress_.say(out_, *news);
  }

  void say_news_of_tracker() {
    const double now = since_start_.seconds();
    if (pipeline_ == nullptr || now - tracker_looked_ < kTrackerLook) return;
    tracker_looked_ = now;
    const auto tracker = pipeline_->world_stage().hands().tracker_status();
    if (!tracker) return;
    if (const auto news = tracker_news_.look(*tracker, now)) progress_.say(out_, *news);
  }

  /// Reports when an array that reconnects by itself is lost, and when it is back.
  void say_news_of_array() {
    if (pipeline_ == nullptr) return;
    const bool gone = pipeline_->device().status() == DeviceStatus::Vanished;
    if (gone == array_gone_) return;
    array_gone_ = gone;
    progress_.say(out_, gone ? pipeline_->device().problem() + "; trying again, silent meanwhile."
                             : "The array is back.");
  }

  Recorder* recorder_;
  const View* view_;
  std::optional<double> picture_at_;
  const RunOptions& options_;
  std::FILE* out_;
  Pipeline* pipeline_ = nullptr;
  StageTimer since_start_;
  double tracker_looked_ = 0.0;  // [s]
  TrackerNews tracker_news_;
  double away_ = std::numeric_limits<double>::infinity();
  WorldFrame contact_;
  PlanFrame plan_;
  PlanSample sample_;
  std::function<void(const RunSummary&)> report_;
  bool reported_ = false, array_gone_ = false;
  std::optional<MuteWatch> mutes_;
  Interrupt interrupt_;
  Progress progress_{"running"};
};

/// Returns the run's options, and applies the command line to the settings.
RunOptions options_of(const RunOptionsGiven& given, PipelineSettings& settings) {
  RunOptions options;
  options.mode = given.stepped               ? RunMode::Stepped
                 : given.as_fast_as_possible ? RunMode::AsFastAsPossible
                                             : RunMode::RealTime;
  const bool realtime = options.mode == RunMode::RealTime;
  settings.devices.of<SimulatedArraySettings>().realtime = realtime;
  check_mode(settings, options.mode);
  if (given.switch_at) settings.emit.switch_at = from_name<SwitchAt>(*given.switch_at, "--switch");
  if (realtime && !given.common.budget_ms) set_live_budget(settings);
  settings.side_view = !given.common.figure.empty();
  check_view(given, realtime);
  return options;
}

/// Returns the run's duration [s]. @param recording length of the hands' recording, or 0 [s].
double seconds_of(const RunOptionsGiven& given, double recording) {
  const double seconds = given.seconds.value_or(recording > 0.0 ? recording : 60.0);
  if (!(seconds > 0.0 && seconds <= 86400.0))
    throw InputError(fmt::format("--seconds {} must be above 0 and at most 86400", seconds));
  if (given.figure_at && !(*given.figure_at >= 0.0 && *given.figure_at <= seconds)) {
    throw InputError(fmt::format("--figure-at {} must be between 0 and the run's {} s",
                                 *given.figure_at, seconds));
  }
  return seconds;
}

std::unique_ptr<Recorder> make_recorder(const RunOptionsGiven& given,
                                        const PipelineSettings& settings) {
  if (given.record.empty()) return nullptr;
  auto recorder = std::make_unique<Recorder>(given.record, settings_groups(settings));
  recorder->set_attribute("prostm", version_text());
  recorder->set_attribute("scene", settings.scene);
  recorder->set_attribute("hand", given.hand);
  return recorder;
}

/// The end of a run: its recording is closed, its summary and its picture are written. Each is
/// tried, even if another fails.
struct Ending {
  const RunOptionsGiven& given;
  const PipelineSettings& settings;
  Pipeline& pipeline;
  Recorder* recorder;
  const Observer& observer;
  const View* view;
  std::FILE* out;
  std::vector<std::string> written = {};  ///< files that are complete

  void report(const RunSummary& summary) {
    const std::optional<TrackerStatus> tracker = pipeline.world_stage().hands().tracker_status();
    const HandReading* const reading = pipeline.world_stage().hands().reading();
    const Verdict verdict = verdict_of(summary, settings, tracker, reading);
    nlohmann::ordered_json json = summary_json(summary, settings, verdict);
    const std::string stopped_by = summary.stopped ? observer.interrupt().cause() : "";
    json["stopped_by"] = stopped_by.empty() ? nullptr : nlohmann::ordered_json(stopped_by);
    json["hand"] = given.hand;
    json["tracker"] = tracker_json(tracker);
    json["hand_file"] = reading_json(reading);
    json["array"] = pipeline.device().description();
    const bool felt = summary.seconds >= kLeastFelt;
    const auto quality = observer.sample().quality(settings, felt);
    const SensationInterval interval = sensation_interval(settings.transducers);
    json["quality"] = run_quality_json(quality);
    json["sensation"] = run_sensation_json(quality, interval);
    json["settings"] = settings_to_json(settings_groups(settings));
    Attempts attempts;
    attempts.add([&] {
      if (recorder == nullptr || !recorder->open()) return;
      recorder->set_attribute("summary", json.dump());
      recorder->close();
      written.push_back(given.record);
    });
    attempts.add([&] {
      write_json(given.common.json, json);
      written.push_back(given.common.json);
    });
    attempts.add([&] { draw(summary, never_came(tracker)); });
    attempts.add([&] {
      print_summary(out, summary, settings, verdict, tracker, reading, stopped_by);
      print_run_quality(out, "the plans", quality, interval,
                        felt
                            ? kPerceptLimits
                            : fmt::format("not computed for runs of less than {:g} s", kLeastFelt));
      say_files();
    });
    attempts.finish();
    if (given.stay && !summary.stopped) view->announce(out);
  }

  void say_files() const {
    for (const std::string& path : written) say_written(out, path);
    flush(out);
  }

 private:
  /// A run that was cut short, or whose tracker never came, may have nothing to draw.
  void draw(const RunSummary& summary, bool no_hand) {
    const std::string& path = given.common.figure;
    if (path.empty()) return;
    if (observer.has_instant()) {
      draw_instant(observer.contact(), observer.plan(), settings, path);
      written.push_back(path);
      return;
    }
    const std::string why =
        "no picture was drawn in " + path + ": no pressure reached a hand during the run";
    if (!summary.stopped && !no_hand) throw InputError(why);
    fmt::print(out, "{}\n", why);
  }
};

/// Prints what the user should know before the run.
void begin_words(const RunOptionsGiven& given, const PipelineSettings& settings) {
  std::FILE* out = prose(given.common.json);
  const std::string doubt = doubt_of_array(settings);
  if (!doubt.empty()) fmt::print(out, "{}\n", doubt);
  obey_lock_memory(given.lock_memory, out);
}

}  // namespace

int run_command(const RunOptionsGiven& given) {
  PipelineSettings settings = make_settings(given.common, given.scene, true);
  settle_hand(given.hand, given.hand_size, settings);
  RunOptions options = options_of(given, settings);
  auto hands = make_hands(given.hand, settings);
  options.seconds = seconds_of(given, hands->recording_length());
  std::unique_ptr<View> view;
  if (given.view) {
    view = std::make_unique<View>(given, settings);
    settings = view->settings();
    hands = view->behind_the_page(std::move(hands));
    options.live = &view->link();
    options.stay = given.stay;
  }
  const Interrupt from_here_on;  // a Ctrl-C as soon as the page is announced ends in a summary
  begin_words(given, settings);
  const auto mute = view ? view->link().mute : std::make_shared<Mute>();
  Pipeline pipeline(settings, std::move(hands), mute);
  if (view) view->serve(pipeline, prose(given.common.json));

  const std::string array = pipeline.device().description();
  if (!array.empty()) fmt::print(prose(given.common.json), "The array: {}.\n", array);
  const std::unique_ptr<Recorder> recorder = make_recorder(given, settings);
  std::optional<double> picture_at;
  if (settings.side_view) picture_at = given.figure_at.value_or(0.5 * options.seconds);
  std::FILE* out = prose(given.common.json);
  Observer observer(recorder.get(), view.get(), picture_at, options, out);
  observer.follow(mute);
  observer.follow(pipeline);
  Ending ending{given, settings, pipeline, recorder.get(), observer, view.get(), out};
  observer.on_report([&ending](const RunSummary& summary) { ending.report(summary); });
  const RunSummary summary = run(pipeline, settings, options, observer);
  observer.end();
  // at once, even if writing the files fails
  const int failed = summary.failure ? tell(summary.failure) : 0;
  const bool stayed = observer.reported();
  if (stayed) {
    ending.say_files();
  } else {
    ending.report(summary);
  }
  if (failed != 0) return failed;
  if (!stayed && observer.interrupt().requested()) return observer.interrupt().status();
  return never_came(pipeline.world_stage().hands().tracker_status()) ? kNoFrame : 0;
}

}  // namespace prostm::app
