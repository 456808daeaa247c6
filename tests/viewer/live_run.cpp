#include "viewer/live_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "pipeline/simulated.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/io/hand/pose_file.hpp"

namespace prostm::test {

namespace {
/// Returns a second of a scripted hand, as a recording.
HandRecording some_recording(const PipelineSettings& s) {
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
}  // namespace

RunOptions for_long() {
  RunOptions options;
  options.seconds = 3600.0;
  return options;
}

PipelineSettings small_settings() {
  PipelineSettings s;
  s.fluid.cells = 32;
  s.scripted_hand.still = true;
  set_live_budget(s);
  return s;
}

std::unique_ptr<HandSource> no_tracker(const PipelineSettings&) {
  return make_absent_hand();
}

LiveRun::LiveRun(const PipelineSettings& settings, RunOptions options, const MakeHand& tracker)
    : pose_file(testing::TempDir() + "prostm_live_test_tracker.json") {
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
  const SensationInterval interval = sensation_interval(settings.transducers);
  view_ = std::make_unique<PipelineView>(
      link_, ViewHello{"0", "simulated usx", "usx", settings.transducers.position, Vec3::Zero(),
                       0.36, interval.below, interval.above, std::string(name_of(interval.sound))});
  ViewSettings view;
  view.port = 0;
  server_ = std::make_unique<ViewServer>(view, *view_, std::span<const PageFile>());
  options.live = &link_;
  thread_ = std::thread(
      [this, settings, options] { summary_ = run(*pipeline_, settings, options, observer_); });
}
LiveRun::~LiveRun() {
  if (thread_.joinable()) stop();
}

RunSummary LiveRun::stop() {
  observer_.stop = true;
  return wait();
}

RunSummary LiveRun::wait() {
  thread_.join();
  return summary_;
}

Json LiveRun::numbers() const {
  const std::string answer = get(port(), "/numbers.json");
  return Json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
}

std::optional<double> LiveRun::number(const char* name) const {
  const Json value = numbers().at("numbers").at(name);
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

int LiveRun::world_steps() const {
  return numbers().at("run").at("world_steps");
}

int LiveRun::plan_updates() const {
  return numbers().at("run").at("plan_updates");
}

unsigned LiveRun::flags() const {
  return numbers().at("run").at("flags");
}

const SimulatedArray& LiveRun::device() const {
  return simulated(*pipeline_);
}

float LiveRun::loudest(std::int64_t first, std::int64_t last) const {
  float most = 0.0F;
  for (const FocusSample& s : device().read_back(first, last - first))
    most = std::max(most, s.intensity);
  return most;
}

bool LiveRun::sounds() const {
  const std::int64_t n = device().samples();
  return n > 400 && loudest(n - 400, n) > 0.1F;
}

void set(Page& page, const char* id, const Json& value) {
  page.say(Json{{"type", "set"}, {"id", id}, {"value", value}}.dump());
}

Json control(const Json& state, const std::string& id) {
  for (const Json& c : state.at("controls"))
    if (c.at("id") == id) return c;
  return nullptr;
}

/// Returns the next state in which a control has this value; other values may precede it.
Json state_with(Page& page, const std::string& id, const Json& value) {
  for (int i = 0; i < 1000; ++i) {
    Json state = page.next_text("state");
    if (control(state, id).at("value") == value) return state;
  }
  throw std::runtime_error("no state has " + value.dump() + " for the control " + id);
}

/// Waits for a state whose transport has this value.
bool transport_becomes(Page& page, const char* key, const Json& value) {
  for (int i = 0; i < 1000; ++i)
    if (page.next_text("state").at("transport").at(key) == value) return true;
  return false;
}

}  // namespace prostm::test
