#pragma once
/// A run in real time with a server, for tests of pages that control it.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>

#include "pipeline/simulated.hpp"
#include "prostm/io/pose_file.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/track/hand_source.hpp"
#include "prostm/viewer/pipeline_view.hpp"
#include "viewer/view_support.hpp"

namespace prostm::test {

class UntilToldToStop final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return !stop; }
  bool on_progress(double) override { return !stop; }
  void on_abandoned_pause(double time) override { abandoned_at = time; }
  std::atomic<bool> stop{false};
  std::atomic<double> abandoned_at{-1.0};  // run time of the last one [s]
};

inline RunOptions for_long() {
  RunOptions options;
  options.seconds = 3600.0;
  return options;
}

inline PipelineSettings small_settings() {
  PipelineSettings s;
  s.fluid.cells = 32;
  s.scripted_hand.still = true;
  s.plan.budget = kLiveBudget;
  return s;
}

/// Returns a second of a scripted hand, as a recording.
inline HandRecording some_recording(const PipelineSettings& s) {
  const auto hand = make_scripted_hand(s.scripted_hand, s.track);
  HandRecording recording;
  for (int i = 0; i <= 100; ++i) {
    HandFrame frame;
    hand->sample(5.0 + 0.01 * i, frame);
    frame.time = 0.01 * i;
    recording.frames.push_back(frame);
  }
  return recording;
}

using MakeHand = std::function<std::unique_ptr<HandSource>(const PipelineSettings&)>;
inline std::unique_ptr<HandSource> no_tracker(const PipelineSettings&) {
  return make_absent_hand();
}

/// A run, its server and its reported numbers.
class LiveRun {
 public:
  /// @param tracker makes the hands of the source "leap".
  explicit LiveRun(const PipelineSettings& settings = small_settings(),
                   RunOptions options = for_long(), const MakeHand& tracker = no_tracker) {
    link_.settings.pipeline = settings;
    link_.settings.source = "scripted";
    link_.settings.sources = {"scripted", "recording", "page", "leap"};
    link_.pose_file = pose_file;
    link_.save_pose = [this](const Calibration& pose) { write_pose(pose_file, pose); };
    link_.page_hand = std::make_shared<PageHand>(settings.track);
    link_.make_hands = [this, tracker](const std::string& source, const PipelineSettings& s) {
      prediction = s.track.prediction;
      auto base = source == "page" ? make_absent_hand()
                  : source == "recording"
                      ? make_recorded_hand(some_recording(s), s.track, true, 1.0 / s.world_rate)
                  : source == "leap" ? tracker(s)
                                     : make_scripted_hand(s.scripted_hand, s.track);
      return std::make_unique<HandSwitch>(std::move(base), link_.page_hand, Pose::Identity());
    };
    auto hands = link_.make_hands("scripted", settings);
    hands->set_tracker_pose(default_tracker_pose());
    link_.hands = hands.get();
    pipeline_ = std::make_unique<Pipeline>(settings, std::move(hands), link_.mute);
    view_ = std::make_unique<PipelineView>(
        link_,
        ViewHello{"0", "simulated usx", "usx", settings.transducers.position, Vec3::Zero(), 0.36});
    ViewSettings view;
    view.port = 0;
    server_ = std::make_unique<ViewServer>(view, *view_, std::span<const PageFile>());
    options.live = &link_;
    thread_ = std::thread(
        [this, settings, options] { summary_ = run(*pipeline_, settings, options, observer_); });
  }
  ~LiveRun() {
    if (thread_.joinable()) stop();
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  RunSummary stop() {
    observer_.stop = true;
    return wait();
  }
  /// Waits until the run ends by itself.
  RunSummary wait() {
    thread_.join();
    return summary_;
  }
  /// Run time at which a pause was given up; −1 before [s].
  double abandoned_at() const { return observer_.abandoned_at; }
  int port() const { return server_->port(); }
  /// Returns the contents of /numbers.json.
  Json numbers() const {
    const std::string answer = get(port(), "/numbers.json");
    return Json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  }
  double number(const char* name) const {
    const Json value = numbers().at("numbers").at(name);
    return value.is_null() ? std::nan("") : value.get<double>();
  }
  int world_steps() const { return numbers().at("run").at("world_steps"); }
  int plan_updates() const { return numbers().at("run").at("plan_updates"); }
  const SimulatedArray& device() const { return simulated(*pipeline_); }
  /// Returns the largest intensity of samples first … last − 1.
  float loudest(std::int64_t first, std::int64_t last) const {
    float most = 0.0F;
    for (const FocusSample& s : device().read_back(first, last - first))
      most = std::max(most, s.intensity);
    return most;
  }
  bool sounds() const {
    const std::int64_t n = device().samples();
    return n > 400 && loudest(n - 400, n) > 0.1F;
  }
  unsigned flags() const { return numbers().at("run").at("flags"); }

  std::atomic<double> prediction{-1};  // setting of the hands made last [s]
  const std::string pose_file = testing::TempDir() + "prostm_live_test_tracker.json";

 private:
  LiveLink link_;
  UntilToldToStop observer_;
  RunSummary summary_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<PipelineView> view_;
  std::unique_ptr<ViewServer> server_;
  std::thread thread_;
};

inline void set(Page& page, const char* id, const Json& value) {
  page.say(Json{{"type", "set"}, {"id", id}, {"value", value}}.dump());
}

inline Json control(const Json& state, const std::string& id) {
  for (const Json& c : state.at("controls"))
    if (c.at("id") == id) return c;
  return nullptr;
}

/// Returns the next state in which a control has this value; other values may precede it.
inline Json state_with(Page& page, const std::string& id, const Json& value) {
  for (int i = 0; i < 1000; ++i) {
    Json state = page.next_text("state");
    if (control(state, id).at("value") == value) return state;
  }
  throw std::runtime_error("no state has " + value.dump() + " for the control " + id);
}

/// Waits for a state whose transport has this value.
inline bool transport_becomes(Page& page, const char* key, const Json& value) {
  for (int i = 0; i < 1000; ++i)
    if (page.next_text("state").at("transport").at(key) == value) return true;
  return false;
}

}  // namespace prostm::test
