/// A real-time run with a page that controls it: requests take effect in the plans.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "viewer/live_run.hpp"

namespace prostm {
namespace {

using test::control;
using test::eventually;
using test::for_long;
using test::Json;
using test::LiveRun;
using test::Page;
using test::set;
using test::small_settings;
using test::state_with;
using test::transport_becomes;
using testing::HasSubstr;

/// The plan section: number of paths or foci, and the kind of the first.
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

/// Waits for a frame whose plan satisfies the condition.
template <class Condition>
bool plan_becomes(Page& page, Condition&& condition) {
  for (int i = 0; i < 2000; ++i)
    if (condition(plan_in(page.next_frame()))) return true;
  return false;
}

TEST(Live, ReportsItsState) {
  LiveRun run;
  Page page(run.port());
  const Json hello = page.next_text("hello");
  EXPECT_EQ(hello.at("array").at("transducers_mm").size(), 256U);
  EXPECT_EQ(hello.at("box_mm").at("edge"), 360.0);
  const SensationInterval interval = sensation_interval(small_settings().transducers);
  EXPECT_EQ(hello.at("sensation").at("below_db"), interval.below);
  EXPECT_EQ(hello.at("sensation").at("above_db"), interval.above);
  EXPECT_EQ(hello.at("sensation").at("sound"), name_of(interval.sound));
  const Json state = page.next_text("state");
  EXPECT_EQ(control(state, "method").at("value"), "pro-stm");
  EXPECT_FALSE(control(state, "gain").contains("unit"));
  EXPECT_EQ(control(state, "speed").at("unit"), "m/s");
  EXPECT_EQ(control(state, "speed").at("max"), 8.0);
  EXPECT_EQ(control(state, "source").at("choices").size(), 4U) << "those available";
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

TEST(Live, ReportsThatTheLinkToTheArrayIsLost) {
  LiveLink link;
  PipelineView view(link, ViewHello{});
  for (const bool lost : {true, false}) {
    link.snapshots.run_draft().device_lost = lost;
    link.snapshots.publish_run();
    ViewFrame frame;
    ViewNews news;
    view.refresh(frame, news);
    EXPECT_EQ((frame.run.flags & kViewDeviceLost) != 0, lost);
  }
}

TEST(Live, ChangedControlsShowInThePlan) {
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
  state_with(page, "scene", "four-plumes");
  const RunSummary summary = run.stop();
  EXPECT_GE(summary.device.queue_blocks, 3);
  EXPECT_LE(summary.device.queue_blocks, 10);
  EXPECT_GE(summary.skipped_updates, 0);
}

TEST(Live, PredictionRecreatesTheHands) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  EXPECT_GT(run.prediction, 0.0);
  set(page, "prediction", false);
  state_with(page, "prediction", false);
  EXPECT_EQ(run.prediction, 0.0);
}

TEST(Live, InvalidRequestsAreRejectedInASentenceAndChangeNothing) {
  PipelineSettings settings = small_settings();
  settings.plan.draw_rate = 500.0;  // leaves a slow focal point no room for a path
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

TEST(Live, APausedRunHaltsAndCanBeSteppedByUpdates) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  ASSERT_TRUE(eventually([&] { return run.plan_updates() > 3; }));
  int updates = 0;
  for (int round = 0; round < 3; ++round) {
    page.say(R"({"type":"transport","do":"pause"})");
    EXPECT_TRUE(transport_becomes(page, "playing", false));
    ASSERT_TRUE(eventually([&] { return (run.flags() & kViewPaused) != 0; }));
    const int steps = run.world_steps();
    updates = run.plan_updates();
    EXPECT_EQ(steps % 2, 0) << "a pause follows a complete update";
    EXPECT_TRUE(eventually([&] { return (run.flags() & kViewFading) != 0; }));
    EXPECT_EQ(run.world_steps(), steps);
    page.say(R"({"type":"transport","do":"step"})");
    EXPECT_TRUE(eventually([&] { return run.plan_updates() == updates + 1; }));
    EXPECT_EQ(run.world_steps(), steps + 2);
    if (round == 2) break;
    page.say(R"({"type":"transport","do":"play"})");
    EXPECT_TRUE(transport_becomes(page, "playing", true));
    EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates + 1; }));
  }
  {
    // a page that connects now also receives the smoke
    Page late(run.port());
    EXPECT_TRUE(test::has_section(late.next_frame(), 4));
  }
  page.say(R"({"type":"transport","do":"play"})");
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates + 3; }));
}

TEST(Live, APauseEndsWithItsLastViewer) {
  RunOptions options;
  options.seconds = 3.0;
  options.pause_kept = 0.5;
  LiveRun run(small_settings(), options);
  {
    Page page(run.port());
    page.say(R"({"type":"transport","do":"pause"})");
    EXPECT_TRUE(transport_becomes(page, "playing", false));
    // a page that watches keeps the pause, for any time
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

TEST(Live, RatesDoNotDependOnHowOftenTheyAreRequested) {
  LiveRun run;
  EXPECT_TRUE(eventually([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    const Json numbers = run.numbers().at("numbers");
    return numbers.at("world_hz") > 0.0 && numbers.at("plan_hz") > 0.0;
  }));
}

TEST(Live, ReportsSkillAndLevelOfTheFeltField) {
  LiveRun run;
  Page page(run.port());  // computed while a page watches
  EXPECT_TRUE(eventually([&] {
    page.next_frame();
    const Json numbers = run.numbers().at("numbers");
    const Json skill = numbers.at("felt_skill"), level = numbers.at("sensation_level");
    return skill.is_number() && skill <= 1.0 && level.is_number() && level < 40.0;
  }));
}

TEST(Live, ReportsTheVerdictOfTheGate) {
  LiveRun run;
  Page page(run.port());
  EXPECT_TRUE(eventually([&] {
    const Json gate = run.numbers().at("gate");
    return !gate.is_null() && !gate.at("sentence").get<std::string>().empty() &&
           gate.at("force_n") > 0.0;
  }));
  EXPECT_TRUE(eventually([&] { return test::has_section(page.next_frame(), 7); }));
  // still air has no required stimulus
  set(page, "scene", "still-air");
  EXPECT_TRUE(eventually([&] { return run.numbers().at("gate").is_null(); }));
}

TEST(Live, RecordingsCanBeSoughtIn) {
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

TEST(Live, ThePagesHandReplacesTheSourceUntilReleased) {
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

// several people drag sliders at once, while pages connect and disconnect
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
