#include "prostm/track/live/openxr_hands.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "prostm/core/file/file.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "support/eventually.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using nlohmann::json;
using test::eventually;

std::size_t hands_of(HandSource& source) {
  HandFrame frame;
  source.sample(0.0, frame);
  return frame.hands.size();
}

/// Sets the environment of the loader and the replay runtime, and restores it on destruction.
class OpenXr : public testing::Test {
 protected:
  OpenXr() {
    set("XR_RUNTIME_JSON", PROSTM_REPLAY_RUNTIME);
    set("PROSTM_REPLAY_HANDS", recording_file());
  }
  ~OpenXr() override {
    for (const std::string& name : names_) ::unsetenv(name.c_str());
  }
  void set(const std::string& name, const std::string& value) {
    ::setenv(name.c_str(), value.c_str(), 1);
    names_.insert(name);
  }

  /// Returns a file with two hands: recorded ones if available, else the scripted hand and its
  /// mirror image.
  std::string recording_file() {
    const std::string flapping = test::shared_file("data/hands/flapping.hands.jsonl");
    if (std::filesystem::exists(flapping)) return flapping;
    return scripted_file({}, 300);
  }
  /// Returns a file with two hands that do not move.
  std::string still_file() {
    ScriptedHandSettings still;
    still.still = true;
    return scripted_file(still, 2);
  }

 private:
  std::string scripted_file(const ScriptedHandSettings& settings, int frames) {
    std::string text =
        json{{"format", "hand-frames"}, {"version", 1}, {"units", "m"}}.dump() + "\n";
    const auto source = make_scripted_hand(settings, {});
    HandFrame frame;
    for (int i = 0; i < frames; ++i) {
      source->sample(5.0 + 0.01 * i, frame);
      json hands = json::array();
      for (const bool left : {true, false}) hands.push_back(neutral(frame.hands.at(0), left));
      text += json{{"t", 0.01 * i}, {"hands", hands}}.dump() + "\n";
    }
    write_file(folder_.file("two.hands.jsonl"), text);
    return folder_.file("two.hands.jsonl");
  }
  static json neutral(const Hand& hand, bool left) {
    json p = json::array(), q = json::array(), r = json::array();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Vec3& x = hand.position[j];
      const Quat& o = hand.orientation[j];
      const double m = left ? -1.0 : 1.0;
      for (const double number : {m * x.x() + m * 0.1, x.y(), x.z()}) p.push_back(number);
      for (const double number : {o.x(), m * o.y(), m * o.z(), o.w()}) q.push_back(number);
      r.push_back(hand.radius[j]);
    }
    return {{"id", left ? 1 : 2}, {"side", left ? "L" : "R"}, {"p", p}, {"q", q}, {"r", r}};
  }

  test::TemporaryFolder folder_;
  std::set<std::string> names_;
};

/// Whether all joints of two hands of one side are at the same places.
bool is_same(const Hand& hand, const Hand& other) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if ((hand.position[j] - other.position[j]).norm() > 1e-6) return false;
  }
  return true;
}

/// Returns the index of the recording's frame with these hands, if any.
std::optional<std::size_t> frame_of(const HandFrame& frame, const HandRecording& recording) {
  const auto has = [&](const HandFrame& known, const Hand& hand) {
    return std::any_of(known.hands.begin(), known.hands.end(), [&](const Hand& other) {
      return other.side == hand.side && is_same(hand, other);
    });
  };
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const HandFrame& known = recording.frames[i];
    if (known.hands.size() == frame.hands.size() &&
        std::all_of(frame.hands.begin(), frame.hands.end(),
                    [&](const Hand& hand) { return has(known, hand); }))
      return i;
  }
  return {};
}

TEST_F(OpenXr, BothHandsArriveThroughTheLoader) {
  const HandRecording recording = read_hand_recording(recording_file());
  const auto tracker = make_openxr_tracker();
  std::set<std::size_t> seen;
  HandFrame frame;
  double last = 0.0;
  // one frame per call: a slow machine compares frames more slowly than they arrive
  ASSERT_TRUE(eventually([&] {
    if (!tracker->next(frame)) return false;
    EXPECT_GT(frame.time, last);
    last = frame.time;
    if (frame.hands.size() != 2) return false;
    EXPECT_EQ(frame.hands[0].side, Side::Left);
    EXPECT_EQ(frame.hands[1].side, Side::Right);
    EXPECT_NE(frame.hands[0].id, frame.hands[1].id);
    const auto found = frame_of(frame, recording);
    EXPECT_TRUE(found) << "these hands are not in the recording";
    if (found) seen.insert(*found);
    return seen.size() >= 50;
  }));
  const TrackerStatus status = tracker->status();
  EXPECT_TRUE(status.connected) << status.sentence;
  EXPECT_EQ(status.dropped, 0);
  EXPECT_EQ(status.reconnects, 0);
  EXPECT_GE(status.frames, 50);
}

TEST_F(OpenXr, ALostSessionIsRequestedAgain) {
  set("PROSTM_REPLAY_LOSS", "0.3");
  const auto hands = make_live_hand(make_openxr_tracker(), {});
  ASSERT_TRUE(eventually([&] { return hands_of(*hands) == 2; }));
  ASSERT_TRUE(eventually([&] { return hands_of(*hands) == 0; }));
  EXPECT_FALSE(hands->tracker_status()->connected);
  EXPECT_THAT(hands->tracker_status()->sentence, testing::HasSubstr("has ended"));
  ASSERT_TRUE(eventually([&] { return hands_of(*hands) == 2; }));
  EXPECT_GE(hands->tracker_status()->reconnects, 1);
}

TEST_F(OpenXr, ConfidenceIsTheFractionOfTrackedJoints) {
  for (const auto& [inferred, confidence] : {std::pair{"0", 1.0}, {"6", 20.0 / 26.0}}) {
    set("PROSTM_REPLAY_INFERRED", inferred);
    const auto hands = make_live_hand(make_openxr_tracker(), {});
    HandFrame frame;
    ASSERT_TRUE(eventually([&] {
      hands->sample(0.0, frame);
      return frame.hands.size() == 2;
    }));
    EXPECT_NEAR(frame.hands[0].confidence, confidence, 1e-12);
    EXPECT_EQ(hands->tracker_status()->unsure, 0);
  }
  // hands with nearly all joints inferred are rejected
  set("PROSTM_REPLAY_INFERRED", "24");
  const auto hands = make_live_hand(make_openxr_tracker(), {});
  HandFrame frame;
  ASSERT_TRUE(eventually([&] {
    hands->sample(0.0, frame);
    EXPECT_TRUE(frame.hands.empty());
    return hands->tracker_status()->unsure > 50;
  }));
  EXPECT_THAT(hands->tracker_status()->sentence, testing::HasSubstr("below 0.1"));
}

TEST_F(OpenXr, AHandWithoutAnyMotionMeansAFrozenTracker) {
  set("PROSTM_REPLAY_HANDS", still_file());
  TrackSettings settings;
  settings.freeze_time = 0.1;
  const auto hands = make_live_hand(make_openxr_tracker(), settings);
  ASSERT_TRUE(eventually([&] { return hands_of(*hands) == 2; }));
  ASSERT_TRUE(eventually([&] { return hands_of(*hands) == 0; }));
  EXPECT_GT(hands->tracker_status()->frozen, 0);
  EXPECT_THAT(hands->tracker_status()->sentence,
              testing::HasSubstr("a hand has not moved at all for 0.1 s"));
}

TEST_F(OpenXr, ReportsWhatIsMissingAndContinuesOnceItIsThere) {
  const auto says = [](const HandSource& hands, const char* words) {
    return eventually(
        [&] { return hands.tracker_status()->sentence.find(words) != std::string::npos; });
  };
  set("PROSTM_REPLAY_WITHOUT", "XR_MND_headless");
  EXPECT_TRUE(says(*make_live_hand(make_openxr_tracker(), {}), "lacks XR_MND_headless"));
  set("PROSTM_REPLAY_WITHOUT", "");
  set("PROSTM_REPLAY_HANDS", "/none.hands.jsonl");
  EXPECT_TRUE(says(*make_live_hand(make_openxr_tracker(), {}), "failed in xrCreateInstance"));

  const test::TemporaryFolder folder;
  const std::string manifest = folder.file("runtime.json");
  set("XR_RUNTIME_JSON", manifest);
  set("PROSTM_REPLAY_HANDS", recording_file());
  const auto hands = make_live_hand(make_openxr_tracker(), {});
  EXPECT_TRUE(says(*hands, "there is no OpenXR runtime here; install one"));
  EXPECT_EQ(hands->tracker_status()->frames, 0);
  write_file(manifest, read_file(PROSTM_REPLAY_RUNTIME));
  EXPECT_TRUE(eventually([&] { return hands_of(*hands) == 2; }));
  EXPECT_EQ(hands->tracker_status()->reconnects, 0);
}

}  // namespace
}  // namespace prostm
