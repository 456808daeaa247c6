/// Held hands and the measurements on them.

#include "plumes/plumes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plumes/held_hand.hpp"
#include "prostm/track/palm.hpp"
#include "support/places.hpp"

namespace prostm::bench {
namespace {

Hand in_device(HandSource& source, double time) {
  HandFrame frame;
  source.sample(time, frame);
  to_device(default_tracker_pose(), frame);
  return frame.hands.at(0);
}

TEST(HeldHand, IsLevelAndAtTheGivenPosition) {
  const auto study = make_study_hand({.size = 0.9});
  const auto held = make_still_hand(*study, {.x = 0.01, .y = -0.02, .height = 0.18});
  const Palm palm = palm_of(in_device(*held, 1.0));
  EXPECT_LT((palm.centre - Vec3(0.01, -0.02, 0.18)).norm(), 1e-9);
  EXPECT_NEAR(palm.tilt, 0.0, 1e-6);
  EXPECT_NEAR(palm.yaw, 0.0, 1e-6);
  const auto tilted = make_still_hand(*study, {.tilt = 0.3});
  EXPECT_NEAR(palm_of(in_device(*tilted, 1.0)).tilt, 0.3, 1e-6);
}

TEST(HeldHand, OfARecordingTremblesLikeItsPalm) {
  const std::string wave = test::source_file("data/wave.hands.jsonl");
  const auto fast = make_held_hand(wave, {.tremor_above = 8.0}),
             held = make_held_hand(wave, {.tremor_above = 4.0}), still = make_held_hand(wave, {});
  const Vec3 centre(0.0, 0.0, 0.215);
  double square = 0.0, of_fast = 0.0, jump = 0.0;
  Vec3 before = in_device(*held, 0.0).position[kPalm];
  for (double t = 0.01; t < 10.0; t += 0.01) {
    const Hand hand = in_device(*held, t);
    square += (hand.position[kPalm] - centre).squaredNorm();
    of_fast += (in_device(*fast, t).position[kPalm] - centre).squaredNorm();
    jump = std::max(jump, (hand.position[kPalm] - before).norm());
    before = hand.position[kPalm];
    ASSERT_NEAR(palm_of(hand).tilt, 0.0, 1e-6);
    ASSERT_LT((in_device(*still, t).position[kPalm] - centre).norm(), 1e-9);
  }
  EXPECT_GT(square, of_fast);
  EXPECT_GT(of_fast, 0.0);
  EXPECT_LT(square, 1000 * 0.01 * 0.01);
  EXPECT_LE(jump, 1.01 * 0.01 * 3.0) << "faster than any hand";
}

TEST(Plumes, AreMeasuredFrameByFrame) {
  PipelineSettings settings;
  settings.scene = "one-plume";
  settings.fluid.cells = 32;
  const std::vector<HeldCase> cases = held_cases("");
  const auto study = std::find_if(cases.begin(), cases.end(),
                                  [](const HeldCase& c) { return c.name == "study hand 1.0"; });
  ASSERT_NE(study, cases.end());
  const Measured measured = measure_plumes(*study, settings, 0.02, 10);
  ASSERT_EQ(measured.frames.size(), 10u);
  EXPECT_EQ(measured.frames.back().count(), 1);
  EXPECT_GT(measured.frames.back().force, 1e-4);
  EXPECT_NEAR(measured.size, 1.0, 0.02);
  EXPECT_FALSE(measured.says.empty());
}

}  // namespace
}  // namespace prostm::bench
