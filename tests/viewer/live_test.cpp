/// A run in real time with a page that steers it: what is asked is seen in what is planned.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "io/pose_file.hpp"
#include "pipeline/runner.hpp"
#include "track/hand_source.hpp"
#include "viewer/pipeline_view.hpp"
#include "viewer/view_support.hpp"

namespace prostm {
namespace {

using test::eventually;
using test::Json;
using test::Page;
using testing::HasSubstr;

class UntilToldToStop final : public RunObserver {
 public:
  bool on_plan(const ContactFrame&, const PlanFrame&) override { return !stop; }
  bool on_progress(double) override { return !stop; }
  void on_abandoned_pause(double time) override { abandoned_at = time; }
  std::atomic<bool> stop{false};
  std::atomic<double> abandoned_at{-1.0};  // run time of the last one [s]
};

RunOptions for_long() {
  RunOptions options;
  options.seconds = 3600.0;
  return options;
}

PipelineSettings small_settings() {
  PipelineSettings s;
  s.fluid.cells = 32;
  s.scripted_hand.still = true;
  s.plan.budget = kLiveBudget;
  return s;
}

/// A second of a scripted hand, as a recording.
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

/// Where the tracker of the tests stands in truth.
Pose true_pose() {
  Pose X_DT = default_tracker_pose();
  X_DT.rotate(Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()));
  X_DT.translation() = Vec3(0.02, 0.12, -0.01);
  return X_DT;
}

/// A tracker that sees one hand, the tip of whose index finger rests on a corner of the array; or,
/// with corner −1, the hand over its middle.
class TouchingHand final : public HandSource {
 public:
  TouchingHand(const std::atomic<int>& corner, const PipelineSettings& s)
      : corner_(corner), hand_(make_scripted_hand(s.scripted_hand, s.track)) {
    Vec3 low = s.transducers.position.front(), high = low;
    for (const Vec3& p : s.transducers.position) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    corners_ = {Vec3(low.x(), low.y(), high.z()), Vec3(high.x(), low.y(), high.z()),
                Vec3(high.x(), high.y(), high.z()), Vec3(low.x(), high.y(), high.z())};
  }
  /// Of the tip while the tracker is believed to stand at X_DT.
  Vec3 tip(int corner, const Pose& X_DT) {
    HandFrame frame;
    hand_->sample(0.0, frame);
    const double flesh = frame.hands.at(0).radius[kIndexTip];
    const Vec3 on_it = corners_[static_cast<std::size_t>(corner)] + flesh * Vec3::UnitZ();
    return X_DT * (true_pose().inverse() * on_it);
  }
  void sample(double time, HandFrame& out) override {
    hand_->sample(time, out);
    if (corner_ < 0) return;
    Hand& hand = out.hands.at(0);
    const Vec3 shift = tip(corner_, Pose::Identity()) - hand.position[kIndexTip];
    for (Vec3& p : hand.position) p += shift;
  }
  double duration() const override { return std::numeric_limits<double>::infinity(); }
  std::optional<TrackerStatus> tracker_status() const override {
    TrackerStatus status;
    status.connected = true;
    status.sentence = "a stand-in";
    return status;
  }

 private:
  const std::atomic<int>& corner_;
  std::unique_ptr<HandSource> hand_;
  std::array<Vec3, 4> corners_;
};

/// A run, its server and the numbers that it tells.
class LiveRun {
 public:
  explicit LiveRun(const PipelineSettings& settings = small_settings(),
                   RunOptions options = for_long()) {
    link_.settings.pipeline = settings;
    link_.settings.source = "scripted";
    link_.settings.sources = {"scripted", "recording", "page", "leap"};
    link_.pose_file = pose_file;
    link_.save_pose = [this](const Calibration& pose) { write_pose(pose_file, pose); };
    link_.page_hand = std::make_shared<PageHand>(settings.track);
    link_.make_hands = [this](const std::string& source, const PipelineSettings& s) {
      prediction = s.track.prediction;
      auto base = source == "page" ? make_absent_hand()
                  : source == "recording"
                      ? make_recorded_hand(some_recording(s), s.track, true, 1.0 / s.fluid_rate)
                  : source == "leap" ? std::make_unique<TouchingHand>(corner, s)
                                     : make_scripted_hand(s.scripted_hand, s.track);
      return std::make_unique<HandSwitch>(std::move(base), link_.page_hand, Pose::Identity());
    };
    auto hands = link_.make_hands("scripted", settings);
    hands->set_tracker_pose(default_tracker_pose());
    link_.hands = hands.get();
    pipeline_ = std::make_unique<Pipeline>(settings, std::move(hands), link_.mute);
    view_ = std::make_unique<PipelineView>(
        link_, ViewHello{"0", "usx", settings.transducers.position, Vec3::Zero(), 0.36});
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
  /// Until the run ends by itself.
  RunSummary wait() {
    thread_.join();
    return summary_;
  }
  /// Run time at which a pause was given up; −1 before [s].
  double abandoned_at() const { return observer_.abandoned_at; }
  int port() const { return server_->port(); }
  /// As /numbers.json tells them.
  Json numbers() const {
    const std::string answer = test::get(port(), "/numbers.json");
    return Json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  }
  double number(const char* name) const {
    const Json value = numbers().at("numbers").at(name);
    return value.is_null() ? std::nan("") : value.get<double>();
  }
  int fluid_steps() const { return numbers().at("run").at("fluid_steps"); }
  int plan_updates() const { return numbers().at("run").at("plan_updates"); }
  const SimulatedArray& device() const { return pipeline_->device(); }
  /// The strongest intensity of samples first … last − 1.
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

  std::atomic<int> corner{0};          // that the finger of "leap" is on
  std::atomic<double> prediction{-1};  // that the hands were last made with [s]
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

void set(Page& page, const char* id, const Json& value) {
  page.say(Json{{"type", "set"}, {"id", id}, {"value", value}}.dump());
}

Json control(const Json& state, const std::string& id) {
  for (const Json& c : state.at("controls"))
    if (c.at("id") == id) return c;
  return nullptr;
}

/// The next state in which a control has a value; what comes before may be of something else.
Json state_with(Page& page, const std::string& id, const Json& value) {
  for (int i = 0; i < 1000; ++i) {
    Json state = page.next_text("state");
    if (control(state, id).at("value") == value) return state;
  }
  throw std::runtime_error("no state has " + value.dump() + " for the control " + id);
}

/// The next state whose transport says this.
bool transport_becomes(Page& page, const char* key, const Json& value) {
  for (int i = 0; i < 1000; ++i)
    if (page.next_text("state").at("transport").at(key) == value) return true;
  return false;
}

/// The plan section: how many paths or foci, and the kind of the first.
struct PlanSeen {
  unsigned count = 0, kind = 9;
};
PlanSeen plan_in(const std::string& bytes) {
  std::size_t at = 16;
  while (at < bytes.size()) {
    const std::uint32_t head = test::u32_at(bytes, at);
    if ((head & 0xFFFFU) == 6) {
      const unsigned count = head >> 16;
      return {count, count > 0 ? test::u32_at(bytes, at + 8) : 9U};
    }
    at += 8 + (test::u32_at(bytes, at + 4) + 7) / 8 * 8;
  }
  return {};
}

/// Waits for a frame whose plan is as it should be.
template <class Condition>
bool plan_becomes(Page& page, Condition&& condition) {
  for (int i = 0; i < 2000; ++i)
    if (condition(plan_in(page.next_frame()))) return true;
  return false;
}

TEST(Live, TellsHowItStands) {
  LiveRun run;
  Page page(run.port());
  const Json hello = page.next_text("hello");
  EXPECT_EQ(hello.at("array").at("transducers_mm").size(), 256U);
  EXPECT_EQ(hello.at("box_mm").at("edge"), 360.0);
  const Json state = page.next_text("state");
  EXPECT_EQ(control(state, "method").at("value"), "pro-stm");
  EXPECT_FALSE(control(state, "gain").contains("unit"));
  EXPECT_EQ(control(state, "speed").at("unit"), "m/s");
  EXPECT_EQ(control(state, "speed").at("max"), 8.0);
  EXPECT_EQ(control(state, "source").at("choices").size(), 4U) << "those that are there";
  EXPECT_EQ(state.at("transport").at("playing"), true);
  EXPECT_EQ(state.at("transport").at("source"), "scripted");
  EXPECT_TRUE(state.at("tracker").is_null());
  ASSERT_TRUE(eventually([&] { return run.number("rmse") > 0.0; }));
  EXPECT_GT(run.number("max_target_pa"), 0.0);
  EXPECT_GT(run.number("blocks"), 0.0);
  const RunSummary summary = run.stop();
  EXPECT_TRUE(summary.stopped);
  EXPECT_GT(summary.plans, 0);
}

TEST(Live, WhatIsTurnedIsSeenInThePlan) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  ASSERT_TRUE(plan_becomes(page, [](PlanSeen p) { return p.count > 2 && p.kind == 0; }));
  set(page, "paths", 2);
  state_with(page, "paths", 2.0);
  EXPECT_TRUE(plan_becomes(page, [](PlanSeen p) { return p.count == 2 && p.kind == 0; }));
  set(page, "method", "am");
  const Json state = state_with(page, "method", "am");
  EXPECT_EQ(control(state, "speed").at("enabled"), false);
  EXPECT_TRUE(plan_becomes(page, [](PlanSeen p) { return p.count == 2 && p.kind == 1; }));
  set(page, "scene", "four-plumes");
  state_with(page, "plumes", 4.0);
  const RunSummary summary = run.stop();
  EXPECT_GE(summary.device.queue_blocks, 3);
  EXPECT_LE(summary.device.queue_blocks, 10);
  EXPECT_GE(summary.skipped_updates, 0);
}

TEST(Live, PredictionMakesTheHandsAnew) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  EXPECT_GT(run.prediction, 0.0);
  set(page, "prediction", false);
  state_with(page, "prediction", false);
  EXPECT_EQ(run.prediction, 0.0);
}

TEST(Live, WhatCannotBeIsRefusedInASentenceAndChangesNothing) {
  PipelineSettings settings = small_settings();
  settings.plan.draw_rate = 500.0;  // so that a slow focal point has no room for a path
  LiveRun run(settings);
  Page page(run.port());
  page.next_text("state");
  const auto refusal = [&] { return page.next_text("error").at("sentence").get<std::string>(); };
  set(page, "no such", 1);
  EXPECT_THAT(refusal(), HasSubstr("no control"));
  set(page, "gain", 99);
  EXPECT_THAT(refusal(), HasSubstr("gain must be a number between"));
  set(page, "method", "magic");
  EXPECT_THAT(refusal(), HasSubstr("pro-stm or am"));
  page.say(R"({"type":"transport","do":"seek","time_s":1})");
  EXPECT_THAT(refusal(), HasSubstr("no recording"));
  set(page, "speed", 4);
  EXPECT_THAT(refusal(), HasSubstr("speed / draw_rate"));
  set(page, "speed", 8);
  EXPECT_EQ(control(state_with(page, "speed", 8.0), "gain").at("value"), 1.4);
}

TEST(Live, APausedRunStandsStillAndGoesOnByUpdates) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  ASSERT_TRUE(eventually([&] { return run.plan_updates() > 3; }));
  int updates = 0;
  for (int round = 0; round < 3; ++round) {
    page.say(R"({"type":"transport","do":"pause"})");
    EXPECT_TRUE(transport_becomes(page, "playing", false));
    ASSERT_TRUE(eventually([&] { return (run.flags() & kViewPaused) != 0; }));
    const int steps = run.fluid_steps();
    updates = run.plan_updates();
    EXPECT_EQ(steps % 2, 0) << "a pause follows a whole update";
    EXPECT_TRUE(eventually([&] { return (run.flags() & kViewFading) != 0; }));
    EXPECT_EQ(run.fluid_steps(), steps);
    page.say(R"({"type":"transport","do":"step"})");
    EXPECT_TRUE(eventually([&] { return run.plan_updates() == updates + 1; }));
    EXPECT_EQ(run.fluid_steps(), steps + 2);
    if (round == 2) break;
    page.say(R"({"type":"transport","do":"play"})");
    EXPECT_TRUE(transport_becomes(page, "playing", true));
    EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates + 1; }));
  }
  {
    // whoever comes now sees the smoke too
    Page late(run.port());
    EXPECT_TRUE(test::has_section(late.next_frame(), 4));
  }
  page.say(R"({"type":"transport","do":"play"})");
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates + 3; }));
}

TEST(Live, APauseEndsWhenNobodyLooksAnyMore) {
  RunOptions options;
  options.seconds = 3.0;
  options.pause_kept = 0.5;
  LiveRun run(small_settings(), options);
  {
    Page page(run.port());
    page.say(R"({"type":"transport","do":"pause"})");
    EXPECT_TRUE(transport_becomes(page, "playing", false));
    // a page that looks keeps the pause, however long
    ASSERT_TRUE(eventually([&] { return (run.flags() & kViewPaused) != 0; }));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_NE(run.flags() & kViewPaused, 0U);
    EXPECT_EQ(run.abandoned_at(), -1.0);
  }
  const RunSummary summary = run.wait();
  EXPECT_GE(run.abandoned_at(), 0.0);
  EXPECT_LT(run.abandoned_at(), 3.0);
  EXPECT_FALSE(summary.stopped);
  EXPECT_NEAR(summary.seconds, 3.0, 0.021);
}

TEST(Live, RatesAreThoseOfTheRunHoweverSeldomTheyAreAskedFor) {
  LiveRun run;
  EXPECT_TRUE(eventually([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    const Json numbers = run.numbers().at("numbers");
    return numbers.at("fluid_hz") > 0.0 && numbers.at("plan_hz") > 0.0;
  }));
}

TEST(Live, RecordingsAreSoughtIn) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  set(page, "source", "recording");
  ASSERT_TRUE(transport_becomes(page, "base", "recording"));
  page.say(R"({"type":"transport","do":"pause"})");
  const Json state = page.next_text("state");
  EXPECT_NEAR(state.at("transport").at("recording").at("length_s").get<double>(), 1.0, 1e-9);
  page.say(R"({"type":"transport","do":"seek","time_s":0.5})");
  EXPECT_TRUE(eventually([&] {
    const Json at = run.numbers().at("run").at("recording_time");
    return !at.is_null() && std::abs(at.get<double>() - 0.5) < 0.05;
  }));
}

TEST(Live, ThePagesHandTakesOverAndLetsGo) {
  LiveRun run;
  Page page(run.port());
  EXPECT_EQ(page.next_text("state").at("transport").at("base"), "scripted");
  const std::string hand =
      R"({"type":"hand","palm_mm":[0,0,200],"yaw_deg":0,"pitch_deg":0,"roll_deg":0,)"
      R"("closure":0,"side":"left"})";
  EXPECT_TRUE(eventually([&] {
    page.say(hand);
    return (run.flags() & kViewPageHand) != 0;
  }));
  EXPECT_TRUE(transport_becomes(page, "source", "page"));
  page.say(R"({"type":"hand","release":true})");
  EXPECT_TRUE(eventually([&] { return (run.flags() & kViewPageHand) == 0; }));
  EXPECT_TRUE(transport_becomes(page, "source", "scripted"));
}

/// The tip of the first hand's index finger [m].
Vec3 tip_in(const std::string& bytes) {
  constexpr unsigned kOneHand = 1U << 16 | 3U;
  std::size_t at = 16;
  while (at < bytes.size() && test::u32_at(bytes, at) != kOneHand)
    at += 8 + (test::u32_at(bytes, at + 4) + 7) / 8 * 8;
  if (at >= bytes.size()) return Vec3::Zero();
  std::array<float, 3> p{};
  std::memcpy(p.data(), bytes.data() + at + 8 + 16 + 32 * kIndexTip, sizeof p);
  return {p[0], p[1], p[2]};
}

TEST(Live, ATrackersPoseIsFoundFromTouches) {
  LiveRun run;
  TouchingHand hand(run.corner, small_settings());
  Page page(run.port());
  page.next_text("state");
  const auto say = [&](const char* what, int mark = 0) {
    page.say(Json{{"type", "calibration"}, {"do", what}, {"mark", mark}}.dump());
  };
  const auto refusal = [&] { return page.next_text("error").at("sentence").get<std::string>(); };
  say("begin");
  EXPECT_THAT(refusal(), HasSubstr("tracker"));
  say("take");
  EXPECT_THAT(refusal(), HasSubstr("begun"));
  set(page, "source", "leap");
  ASSERT_TRUE(transport_becomes(page, "base", "leap"));

  // a tracker's states come four times a second, whatever happens
  const auto becomes = [&](auto&& condition) {
    for (int i = 0; i < 100; ++i) {
      const Json text = page.next_text();
      EXPECT_EQ(text.at("type"), "state") << text;
      if (text.at("type") == "state" && condition(text.at("calibration"))) return true;
    }
    return false;
  };
  const auto finger_is_at = [&](const Vec3& p) {
    for (int i = 0; i < 2000; ++i)
      if ((tip_in(page.next_frame()) - p).norm() < 1e-4) return true;
    return false;
  };
  const auto take = [&](int mark) {
    say("take", mark);
    for (;;) {
      const Json answer = page.next_text();
      if (answer.at("type") == "error") return answer.at("sentence").get<std::string>();
      if (answer.at("calibration").at("marks").at(static_cast<std::size_t>(mark)).at("taken") ==
          true)
        return std::string();
    }
  };
  const auto touch = [&](int marks) {
    for (int mark = 0; mark < marks; ++mark) {
      run.corner = mark;
      ASSERT_TRUE(finger_is_at(hand.tip(mark, default_tracker_pose()))) << mark;
      // the finger has to rest for a while first
      ASSERT_TRUE(eventually([&] { return take(mark).empty(); })) << mark;
    }
  };

  say("begin");
  ASSERT_TRUE(becomes([](const Json& c) { return !c.is_null() && c.at("marks").size() == 4; }));
  say("save");
  EXPECT_THAT(refusal(), HasSubstr("no pose"));
  touch(4);
  say("solve");
  ASSERT_TRUE(becomes([](const Json& c) { return !c.at("residual_mm").is_null(); }));
  EXPECT_TRUE(finger_is_at(hand.tip(3, true_pose()))) << "what is found is used at once";
  say("begin");
  ASSERT_TRUE(becomes([](const Json& c) { return c.at("marks").at(0).at("taken") == false; }));
  say("cancel");
  ASSERT_TRUE(becomes([](const Json& c) { return c.is_null(); }));
  EXPECT_TRUE(finger_is_at(hand.tip(3, default_tracker_pose()))) << "what was not saved goes";

  say("begin");
  ASSERT_TRUE(becomes([](const Json& c) { return !c.is_null(); }));
  page.say(R"({"type":"transport","do":"pause"})");
  ASSERT_TRUE(eventually([&] { return (run.flags() & kViewPaused) != 0; }));
  EXPECT_THAT(take(0), HasSubstr("paused"));
  page.say(R"({"type":"transport","do":"play"})");
  touch(3);
  say("solve");
  ASSERT_TRUE(becomes([](const Json& c) { return !c.at("residual_mm").is_null(); }));
  say("save");
  ASSERT_TRUE(becomes([](const Json& c) { return c.at("saved") == true; }));
  EXPECT_TRUE(read_pose(run.pose_file).X_DT.isApprox(true_pose(), 1e-3));
  std::remove(run.pose_file.c_str());
  say("cancel");
  ASSERT_TRUE(becomes([](const Json& c) { return c.is_null(); }));
  EXPECT_TRUE(finger_is_at(hand.tip(2, true_pose()))) << "what was saved stays";
}

/// Whether the array is silent for a fifth of a second, from 50 ms after now on, while plans go on.
void expect_silence(const LiveRun& run) {
  const std::int64_t silent = run.device().samples() + 2000, end = silent + 8000;
  const int updates = run.plan_updates();
  ASSERT_TRUE(eventually([&] { return run.device().samples() >= end; }));
  EXPECT_EQ(run.loudest(silent, end), 0.0F);
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates; }));
}

TEST(Live, TheArrayIsSilentDuringACalibration) {
  LiveRun run;
  run.corner = -1;
  Page page(run.port());
  page.next_text("state");
  set(page, "source", "leap");
  ASSERT_TRUE(transport_becomes(page, "base", "leap"));
  const auto say = [](Page& who, const char* what) {
    who.say(Json{{"type", "calibration"}, {"do", what}}.dump());
  };
  const auto calibrates = [&](bool muted) {
    for (int i = 0; i < 100; ++i) {
      const Json calibration = page.next_text("state").at("calibration");
      if (calibration.is_null() != muted) {
        EXPECT_TRUE(!muted || calibration.at("muted") == true) << calibration;
        return true;
      }
    }
    return false;
  };

  ASSERT_TRUE(eventually([&] { return run.sounds(); }));
  say(page, "begin");
  ASSERT_TRUE(calibrates(true));
  expect_silence(run);
  // another method has another emitter, which is silent too
  set(page, "method", "am");
  state_with(page, "method", "am");
  expect_silence(run);
  say(page, "begin");
  expect_silence(run);
  say(page, "cancel");
  ASSERT_TRUE(calibrates(false));
  EXPECT_TRUE(eventually([&] { return run.sounds(); }));

  {
    Page other(run.port());
    say(other, "begin");
    ASSERT_TRUE(calibrates(true));
    expect_silence(run);
  }
  ASSERT_TRUE(calibrates(false)) << "a calibration ends with its page";
  EXPECT_TRUE(eventually([&] { return run.sounds(); }));
}

// sliders that are dragged by several people at once, while pages come and go
TEST(Live, SurvivesManyChangesAtOnce) {
  LiveRun run;
  std::vector<std::thread> pages;
  for (int n = 0; n < 3; ++n) {
    pages.emplace_back([&run, n] {
      for (int round = 0; round < 3; ++round) {
        Page page(run.port());
        for (int i = 0; i < 10; ++i) {
          set(page, "gain", 0.5 + 0.1 * i);
          set(page, n == 0 ? "method" : "scene",
              n == 0 ? (i % 2 == 0 ? "am" : "pro-stm") : (i % 2 == 0 ? "still-air" : "two-plumes"));
          page.say(R"({"type":"transport","do":"step"})");
          page.next_frame();
        }
        page.say(R"({"type":"transport","do":"play"})");
      }
    });
  }
  for (std::thread& page : pages) page.join();
  const int updates = run.plan_updates();
  Page page(run.port());
  page.say(R"({"type":"transport","do":"play"})");
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates + 2; }));
  const RunSummary summary = run.stop();
  EXPECT_GT(summary.device.blocks, 0);
}

}  // namespace
}  // namespace prostm
