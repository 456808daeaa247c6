#include "prostm/track/detail/hand_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "support/heap_guard.hpp"
#include "track/hands.hpp"

namespace prostm {
namespace {

using test::hand_at;

const Vec3 kPlace(0.01, 0.2, 0.03), kOther(-0.1, 0.2, 0.0);

HandFrame frame_at(double time, std::initializer_list<Hand> hands) {
  HandFrame frame;
  frame.time = time;
  for (const Hand& hand : hands) frame.hands.push_back(hand);
  return frame;
}

/// Passes a tracker's hands to a HandWatch, frame by frame at 100 Hz.
class Watched {
 public:
  explicit Watched(const TrackSettings& settings = {}) : watch(settings) {}
  /// Returns the ids of the accepted hands.
  std::vector<std::int64_t> take(std::initializer_list<Hand> hands) {
    HandFrame frame = frame_at(0.01 * ++frames_, hands);
    watch.check(frame);
    std::vector<std::int64_t> ids;
    for (const Hand& hand : frame.hands) ids.push_back(hand.id);
    return ids;
  }
  TrackerStatus status() const {
    TrackerStatus status;
    status.connected = true;
    status.sentence = "connected";
    watch.report(status);
    return status;
  }

  HandWatch watch;

 private:
  int frames_ = 0;
};

using testing::ElementsAre;
using testing::IsEmpty;

TEST(HandWatch, AHandWithoutAnyMotionIsRejectedUntilItMoves) {
  Watched watched;
  for (int i = 0; i < 50; ++i) ASSERT_THAT(watched.take({hand_at(1, kPlace)}), ElementsAre(1)) << i;
  EXPECT_EQ(watched.status().sentence, "connected");
  for (int i = 0; i < 50; ++i) ASSERT_THAT(watched.take({hand_at(1, kPlace)}), IsEmpty()) << i;
  EXPECT_EQ(watched.status().frozen, 50);
  EXPECT_EQ(watched.status().sentence,
            "connected; a hand has not moved at all for 0.5 s: the tracker is frozen");
  EXPECT_THAT(watched.take({hand_at(1, kPlace + Vec3(5e-5, 0, 0))}), ElementsAre(1));
  EXPECT_EQ(watched.status().sentence, "connected");
}

TEST(HandWatch, NewIdsAndGapsAreNoMotion) {
  Watched watched;
  for (int i = 0; i < 50; ++i) ASSERT_THAT(watched.take({hand_at(i, kPlace)}), ElementsAre(i));
  for (int i = 50; i < 60; ++i) {
    ASSERT_THAT(watched.take({hand_at(i, kPlace)}), IsEmpty());
    ASSERT_THAT(watched.take({}), IsEmpty());
  }
  for (int i = 60; i < 100; ++i) ASSERT_THAT(watched.take({hand_at(i, kPlace)}), IsEmpty());
}

TEST(HandWatch, TheNoiseOfATrackerAndOneJointAreMotion) {
  Watched watched;
  for (int i = 0; i < 200; ++i) {
    Hand hand = hand_at(1, kPlace);
    if (i % 2 == 0) hand.position[kLittleTip].z() += 2e-5;
    ASSERT_THAT(watched.take({hand}), ElementsAre(1)) << i;
  }
}

TEST(HandWatch, TheHandNextToAFrozenOneIsAccepted) {
  Watched watched;
  for (int i = 0; i < 100; ++i) {
    const Hand frozen = hand_at(1, kPlace), moving = hand_at(2, kOther + 1e-3 * i * Vec3::UnitY());
    // in either order, and while the frozen hand flickers
    const auto taken = i % 3 == 0   ? watched.take({moving, frozen})
                       : i % 3 == 1 ? watched.take({frozen, moving})
                                    : watched.take({moving});
    if (i >= 51) {
      ASSERT_THAT(taken, ElementsAre(2)) << i;
    }
  }
  EXPECT_GT(watched.status().frozen, 25);
}

TEST(HandWatch, AHandBelowTheMinimumConfidenceIsRejected) {
  TrackSettings settings;
  settings.least_confidence = 0.3;
  Watched watched(settings);
  Hand unsure = hand_at(1, kPlace), sure = hand_at(2, kOther);
  unsure.confidence = 0.29;
  sure.confidence = 0.3;
  EXPECT_THAT(watched.take({unsure, sure}), ElementsAre(2));
  EXPECT_THAT(watched.take({unsure}), IsEmpty());
  EXPECT_EQ(watched.status().unsure, 2);
  EXPECT_EQ(watched.status().frozen, 0);
  EXPECT_EQ(watched.status().sentence,
            "connected; 2 hands were ignored: their confidence was below 0.3");
  // without a bound all hands are accepted
  settings.least_confidence = 0.0;
  Watched all(settings);
  unsure.confidence = 0.0;
  EXPECT_THAT(all.take({unsure}), ElementsAre(1));
}

TEST(HandWatch, AllocatesNothingAndRejectsSettingsOutOfBounds) {
  HandWatch watch({});
  HandFrame frame = frame_at(1.0, {hand_at(1, kPlace), hand_at(2, kOther)});
  const test::HeapGuard guard;
  for (int i = 0; i < 100; ++i) {
    HandFrame copy = frame;
    copy.time = 0.01 * i;
    watch.check(copy);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  TrackSettings settings;
  settings.freeze_time = 0.0;
  EXPECT_THROW(HandWatch{settings}, std::invalid_argument);
  settings = {};
  settings.least_confidence = 1.5;
  EXPECT_THROW(HandWatch{settings}, std::invalid_argument);
}

}  // namespace
}  // namespace prostm
