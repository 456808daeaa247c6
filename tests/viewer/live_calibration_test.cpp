/// Calibration of a tracker from a page during a run in real time.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "prostm/io/hand/pose_file.hpp"
#include "viewer/live_run.hpp"

namespace prostm {
namespace {

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

/// Returns the true pose of the tests' tracker.
Pose true_pose() {
  Pose X_DT = default_tracker_pose();
  X_DT.rotate(Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()));
  X_DT.translation() = Vec3(0.02, 0.12, -0.01);
  return X_DT;
}

/// A tracker with one hand, whose index tip rests on a corner of the array. For corner −1 the hand
/// hovers over the array's middle.
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
  /// Returns the position of the tip if the tracker's pose is assumed to be X_DT.
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

/// Returns a factory for the run's tracker: a hand that touches `corner`.
test::MakeHand touching(const std::atomic<int>& corner) {
  return [&corner](const PipelineSettings& s) { return std::make_unique<TouchingHand>(corner, s); };
}

/// Returns the position of the first hand's index tip [m].
Vec3 tip_in(const std::string& bytes) {
  constexpr unsigned kOneHand = 1U << 16 | 3U;
  std::size_t at = 16;
  while (at < bytes.size() && test::u32_at(bytes, at) != kOneHand)
    at += 8 + (test::u32_at(bytes, at + 4) + 7) / 8 * 8;
  if (at >= bytes.size()) return Vec3::Zero();
  std::array<float, 3> p{};
  std::memcpy(p.data(), bytes.data() + at + 8 + 16 + 32 * kIndexTip, sizeof p);
  return Eigen::Map<const Eigen::Vector3f>(p.data()).cast<double>();
}

TEST(LiveCalibration, ATrackersPoseIsFoundFromTouches) {
  std::atomic<int> corner{0};
  LiveRun run(small_settings(), for_long(), touching(corner));
  TouchingHand hand(corner, small_settings());
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

  // a tracker's states arrive four times a second
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
      corner = mark;
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
  EXPECT_TRUE(finger_is_at(hand.tip(3, true_pose()))) << "the solution is used at once";
  say("begin");
  ASSERT_TRUE(becomes([](const Json& c) { return c.at("marks").at(0).at("taken") == false; }));
  say("cancel");
  ASSERT_TRUE(becomes([](const Json& c) { return c.is_null(); }));
  EXPECT_TRUE(finger_is_at(hand.tip(3, default_tracker_pose()))) << "an unsaved pose is discarded";

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
  EXPECT_TRUE(finger_is_at(hand.tip(2, true_pose()))) << "a saved pose is kept";
}

/// Checks that the array is silent for 0.2 s, starting 50 ms from now, while plans
/// continue.
void expect_silence(const LiveRun& run) {
  const std::int64_t silent = run.device().samples() + 2000, end = silent + 8000;
  const int updates = run.plan_updates();
  ASSERT_TRUE(eventually([&] { return run.device().samples() >= end; }));
  EXPECT_EQ(run.loudest(silent, end), 0.0F);
  EXPECT_TRUE(eventually([&] { return run.plan_updates() > updates; }));
}

TEST(LiveCalibration, TheArrayIsSilentDuringACalibration) {
  const std::atomic<int> corner{-1};
  LiveRun run(small_settings(), for_long(), touching(corner));
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
  // the other method has a separate emitter, which is silent too
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
  ASSERT_TRUE(calibrates(false)) << "closing the page ends the calibration";
  EXPECT_TRUE(eventually([&] { return run.sounds(); }));
}

}  // namespace
}  // namespace prostm
