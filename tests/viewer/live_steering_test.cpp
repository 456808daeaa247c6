/// A real-time run with pages that mute it, take its hand, pause it and flood it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "viewer/live_run.hpp"

namespace prostm {
namespace {

using test::control;
using test::eventually;
using test::Json;
using test::LiveRun;
using test::Page;
using test::set;
using test::state_with;
using test::transport_becomes;
using testing::HasSubstr;

/// Numbers of world steps and plan updates in a frame.
using Instant = std::pair<std::uint32_t, std::uint32_t>;
struct RunSeen {
  Instant at;
  std::uint32_t flags = 0;
};
RunSeen run_in(const std::string& frame) {
  constexpr std::size_t kRun = 16 + 8 + 16;  // after the header, the section's head and two times
  return {{test::u32_at(frame, kRun), test::u32_at(frame, kRun + 4)},
          test::u32_at(frame, kRun + 8)};
}

TEST(LiveSteering, TheStateHoldsTheSettingsAtTheStartAndNow) {
  LiveRun run;
  Page page(run.port());
  EXPECT_EQ(page.next_text("hello").at("page"), 1);
  Json state = page.next_text("state");
  EXPECT_EQ(state.at("rates").at("world_hz"), 50.0);
  EXPECT_EQ(state.at("rates").at("plan_hz"), 25.0);
  EXPECT_EQ(control(state, "paths").at("default"), 4.0);
  EXPECT_EQ(control(state, "method").at("default"), "pro-stm");
  EXPECT_THAT(state.at("settings").get<std::string>(), HasSubstr("[fluid]\ncells = 32\n"));
  set(page, "paths", 2);
  set(page, "method", "am");
  state_with(page, "paths", 2.0);
  state = state_with(page, "method", "am");
  EXPECT_EQ(control(state, "paths").at("default"), 4.0);
  EXPECT_EQ(state.at("rates").at("plan_hz"), 50.0);
  EXPECT_THAT(state.at("settings").get<std::string>(), HasSubstr("[am]\nfoci = 2\n"));
}

TEST(LiveSteering, AnErrorNamesTheControl) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  set(page, "gain", 99);
  EXPECT_EQ(page.next_text("error").at("id"), "gain");
  page.say("{}");
  EXPECT_FALSE(page.next_text("error").contains("id"));
}

TEST(LiveSteering, APageMutesTheOutputUntilAPageUnmutesIt) {
  LiveRun run;
  {
    Page page(run.port());
    page.next_text("state");
    ASSERT_TRUE(eventually([&] { return run.sounds(); }));
    page.say(R"({"type":"mute","on":true})");
    ASSERT_TRUE(eventually([&] { return (run.flags() & kViewMuted) != 0; }));
  }
  // 50 ms for the queue and the fade; it stays muted although that page has closed
  const std::int64_t silent = run.device().samples() + 2000, end = silent + 8000;
  const int updates = run.plan_updates();
  ASSERT_TRUE(eventually([&] { return run.device().samples() >= end; }));
  EXPECT_EQ(run.loudest(silent, end), 0.0F);
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates; })) << "planning continues";
  EXPECT_EQ(run.number("intensity"), 0.0);
  Page other(run.port());
  EXPECT_NE(run_in(other.next_frame()).flags & kViewMuted, 0U);
  other.say(R"({"type":"mute","on":false})");
  EXPECT_TRUE(eventually([&] { return run.sounds(); }));
  // frames lag slightly behind the device
  EXPECT_TRUE(eventually([&] { return (run.flags() & kViewMuted) == 0; }));
}

TEST(LiveSteering, APageThatLosesTheHandIsNotified) {
  LiveRun run;
  Page first(run.port()), second(run.port());
  const int one = first.next_text("hello").at("page"), two = second.next_text("hello").at("page");
  ASSERT_NE(one, two);
  const auto hand = [](bool take) {
    Json json = {{"type", "hand"}, {"palm_mm", {0, 0, 200}}, {"yaw_deg", 0},  {"pitch_deg", 0},
                 {"roll_deg", 0},  {"closure", 0},           {"side", "left"}};
    if (take) json["take"] = true;
    return json.dump();
  };
  ASSERT_TRUE(eventually([&] {
    first.say(hand(true));
    return (run.flags() & kViewPageHand) != 0;
  }));
  EXPECT_TRUE(transport_becomes(second, "hand_page", one));
  second.say(hand(false));
  EXPECT_THAT(second.next_text("error").at("sentence").get<std::string>(),
              HasSubstr("another page has the hand"));
  second.say(hand(true));
  EXPECT_TRUE(transport_becomes(first, "hand_page", two));
  first.say(hand(false));
  EXPECT_THAT(first.next_text("error").at("sentence").get<std::string>(),
              HasSubstr("another page has the hand"));
  second.say(R"({"type":"hand","release":true})");
  EXPECT_TRUE(transport_becomes(second, "hand_page", nullptr));
}

TEST(LiveSteering, AHiddenPageReleasesTheHandAndThatIsReported) {
  LiveRun run;
  Page page(run.port());
  const std::string hand = R"({"type":"hand","palm_mm":[0,0,200],"yaw_deg":0,"pitch_deg":0,)"
                           R"("roll_deg":0,"closure":0,"side":"left","take":true})";
  ASSERT_TRUE(eventually([&] {
    page.say(hand);
    return (run.flags() & kViewPageHand) != 0;
  }));
  EXPECT_TRUE(transport_becomes(page, "page_hand", "held"));
  page.say(R"({"type":"hand","release":true,"hidden":true})");
  EXPECT_TRUE(transport_becomes(page, "page_hand", "hidden"));
  const Json told = run.numbers().at("run").at("page_hand");
  EXPECT_EQ(told.at("state"), "hidden");
  EXPECT_EQ(told.at("hidden"), 1);
  const RunSummary summary = run.stop();
  EXPECT_EQ(summary.hidden_page_hands, 1);
}

// a hidden page sends its messages a second apart
TEST(LiveSteering, LatePagesDoNotAlternateInHoldingTheHand) {
  LiveRun run;
  Page first(run.port()), second(run.port());
  const int one = first.next_text("hello").at("page");
  const std::string hand = R"({"type":"hand","palm_mm":[0,0,200],"yaw_deg":0,"pitch_deg":0,)"
                           R"("roll_deg":0,"closure":0,"side":"left"})";
  ASSERT_TRUE(eventually([&] {
    first.say(hand);
    return (run.flags() & kViewPageHand) != 0;
  }));
  ASSERT_TRUE(transport_becomes(first, "hand_page", one));
  ASSERT_TRUE(transport_becomes(first, "page_hand", "late"));
  second.say(hand);
  EXPECT_THAT(second.next_text("error").at("sentence").get<std::string>(),
              HasSubstr("another page has the hand"));
  first.say(hand);
  for (int i = 0; i < 30; ++i) {
    first.next_frame();
    EXPECT_EQ(run.flags() & kViewPageHand, 0U);
  }
  EXPECT_GE(run.stop().late_page_hands, 1);
}

// all data that a paused page shows are of one step, even while it makes single steps
TEST(LiveSteering, APauseShowsOneInstant) {
  LiveRun run;
  Page page(run.port());
  page.say(R"({"type":"rate","hz":60})");
  page.next_text("state");
  for (int round = 0; round < 12; ++round) {
    const int updates = run.plan_updates();
    ASSERT_TRUE(eventually([&] {
      page.next_frame();
      return run.plan_updates() > updates + 2;
    }));
    page.say(R"({"type":"transport","do":"pause"})");
    RunSeen seen;
    while ((seen.flags & kViewPaused) == 0) seen = run_in(page.next_frame());
    Instant at = seen.at;
    for (int i = 0; i < 6; ++i) ASSERT_EQ(run_in(page.next_frame()).at, at) << round;
    for (int step = 0; step < 3; ++step) {
      const Instant next = {at.first + 2, at.second + 1};
      page.say(R"({"type":"transport","do":"step"})");
      Instant now = at;
      while (now == at) now = run_in(page.next_frame()).at;
      ASSERT_EQ(now, next) << round;
      at = next;
    }
    page.say(R"({"type":"transport","do":"play"})");
  }
}

TEST(LiveSteering, AFloodOfSettingsDoesNotStallTheRun) {
  LiveRun run;
  Page page(run.port());
  page.next_text("state");
  ASSERT_TRUE(eventually([&] { return run.plan_updates() > 5; }));
  int sent = 0;
  const int before = run.plan_updates();
  EXPECT_TRUE(eventually([&] {
    for (int i = 0; i < 20; ++i) {
      set(page, "gain", 1.0 + 0.1 * (++sent % 10));
      page.catch_up();
      std::this_thread::sleep_for(std::chrono::microseconds(600));
    }
    return sent > 1000 && run.plan_updates() > before + 14;
  }));
  set(page, "gain", 2.5);
  EXPECT_EQ(control(state_with(page, "gain", 2.5), "gain").at("value"), 2.5);
}

}  // namespace
}  // namespace prostm
