#include "prostm/stimulus/stimulus_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

constexpr int kUpdates = 25;
const Stimulus kFour{4, 23e-4, 0.0};

HandFrame held() {
  HandFrame frame;
  make_study_hand({})->sample(0.0, frame);
  to_device(default_tracker_pose(), frame);
  return frame;
}

HandFrame turned(const Eigen::AngleAxisd& turn) {
  HandFrame frame = held();
  const Vec3 centre = frame.hands[0].position[kPalm];
  for (Vec3& p : frame.hands[0].position) p = centre + turn * (p - centre);
  return frame;
}

HandFrame moved(const Vec3& by) {
  HandFrame frame = held();
  for (Vec3& p : frame.hands[0].position) p += by;
  return frame;
}

HandFrame fist() {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(0.77 * 20.0, frame);
  to_device(default_tracker_pose(), frame);
  return frame;
}

/// Four bells 52 mm apart, one of them with another height.
TargetFrame four(double fourth = 1.0, double width = 0.012) {
  TargetFrame frame;
  TargetField& field = frame.patches.emplace_back();
  field.cell = 0.004;
  field.origin = Vec2(-0.06, -0.06);
  field.resize(31, 31);
  for (std::size_t c = 0; c < field.size(); ++c) {
    field.skin[c] = 1;
    for (int q = 0; q < 4; ++q) {
      const Vec2 centre((q & 1) != 0 ? 0.026 : -0.026, (q & 2) != 0 ? 0.026 : -0.026);
      field.pressure[c] +=
          (q == 3 ? 0.1 * fourth : 0.1) *
          std::exp(-(field.position(c) - centre).squaredNorm() / (2 * width * width));
    }
  }
  return frame;
}

GateResult after_a_second(const HandFrame& hands, const TargetFrame& target,
                          const Stimulus& wanted = kFour) {
  StimulusGate gate(kUpdates, 10'000);
  GateResult result;
  for (int n = 0; n < kUpdates; ++n) result = gate.judge(hands, target, {wanted, {}});
  return result;
}

TEST(StimulusGate, PassesAHeldHandOnceMostOfASecondIsGood) {
  StimulusGate gate(kUpdates, 10'000);
  int first = 0;
  for (int n = 1; n <= kUpdates && first == 0; ++n) {
    const GateResult result = gate.judge(held(), four(), {kFour, {}});
    if (result.pass) first = n;
  }
  EXPECT_EQ(first, 20);
  EXPECT_THAT(sentence(after_a_second(held(), four())), HasSubstr("4 places of pressure"));
}

TEST(StimulusGate, RejectsHandsAndExplainsWhatToDo) {
  struct Case {
    HandFrame hands;
    GateProblem problem;
    const char* words;
  };
  HandFrame two = held();
  two.hands.push_back(two.hands[0]);
  HandFrame moving = held();
  moving.hands[0].velocity[kPalm] = Vec3(0.1, 0, 0);
  const Case cases[] = {
      {{}, GateProblem::NoHand, "There is no hand"},
      {two, GateProblem::TwoHands, "take one away"},
      {fist(), GateProblem::Bent, "Stretch the fingers"},
      {turned(Eigen::AngleAxisd(0.4, Vec3::UnitY())), GateProblem::Tilted, "tilted by 23°"},
      {moved(Vec3(0.04, -0.02, 0)), GateProblem::Beside,
       "Move the hand 40 mm to the left and 20 mm away from you"},
      {moved(Vec3(-0.03, 0, 0)), GateProblem::Beside, "Move the hand 30 mm to the right:"},
      {moved(Vec3(0, 0, -0.1)), GateProblem::Low, "Lift the hand"},
      {moved(Vec3(0, 0, 0.1)), GateProblem::High, "Lower the hand"},
      {moving, GateProblem::Moving, "0.10 m/s"}};
  for (const Case& c : cases) {
    const GateResult result = after_a_second(c.hands, four());
    EXPECT_FALSE(result.pass);
    EXPECT_EQ(result.finding.problem, c.problem) << c.words;
    EXPECT_THAT(sentence(result), HasSubstr(c.words));
  }
}

// a value that slightly misses its bound is not printed as the bound
TEST(StimulusGate, DistinguishesValuesFromTheirBounds) {
  const double height = held().hands[0].position[kPalm].z();
  const auto at = [&](double palm) {
    return sentence(after_a_second(moved(Vec3(0, 0, palm - height)), four()));
  };
  EXPECT_THAT(at(0.1299), HasSubstr("the palm is 129.9 mm above the array (at least 130.0 mm)"));
  EXPECT_THAT(at(0.2602), HasSubstr("the palm is 260.2 mm above the array (at most 260.0 mm)"));
  HandFrame moving = held();
  moving.hands[0].velocity[kPalm] = Vec3(0.0504, 0, 0);
  EXPECT_THAT(sentence(after_a_second(moving, four())),
              HasSubstr("it moves at 0.0504 m/s (at most 0.0500 m/s)"));
}

TEST(StimulusGate, RejectsFieldsAndExplainsTheProblem) {
  EXPECT_EQ(after_a_second(held(), four(0.0)).finding.problem, GateProblem::Maxima);
  EXPECT_EQ(after_a_second(held(), four(0.7)).finding.problem, GateProblem::Balance);
  EXPECT_EQ(after_a_second(held(), four(1.0, 0.022)).finding.problem, GateProblem::Saddle);
  EXPECT_EQ(after_a_second(held(), four(), {4, 64e-4, 0.0}).finding.problem, GateProblem::Area);
  const double force = after_a_second(held(), four()).shape.force;
  EXPECT_TRUE(after_a_second(held(), four(), {4, 0.0, 1.09 * force}).pass);
  EXPECT_EQ(after_a_second(held(), four(), {4, 0.0, 1.2 * force}).finding.problem,
            GateProblem::Force);
  EXPECT_TRUE(after_a_second(held(), four(0.0), {0, 0.0, 0.0}).pass) << "no stimulus is required";
  EXPECT_THAT(sentence(after_a_second(held(), four(0.7))), HasSubstr("70 % of the strongest"));
}

TEST(StimulusGate, AFifthOfBadFramesIsTolerated) {
  StimulusGate gate(kUpdates, 10'000);
  GateResult result;
  for (int n = 0; n < 4 * kUpdates; ++n)
    result = gate.judge(held(), n % 5 == 0 ? four(0.7) : four(), {kFour, {}});
  EXPECT_TRUE(result.pass);
  EXPECT_NEAR(result.share, 0.8, 1e-9);
  for (int n = 0; n < kUpdates; ++n)
    result = gate.judge(held(), n % 4 == 0 ? four(0.7) : four(), {kFour, {}});
  EXPECT_FALSE(result.pass);
}

TEST(Stimulus, IsProportionalToTheSquareOfSizeAndSpeed) {
  const Stimulus half = Stimulus{4, 64e-4, 0.6e-3}.scaled(0.5, 2.0);
  EXPECT_EQ(half.maxima, 4);
  EXPECT_NEAR(half.area, 16e-4, 1e-12);
  EXPECT_NEAR(half.force, 0.6e-3, 1e-12);
  EXPECT_NEAR(half.area_margin, 3.75e-4, 1e-12);
}

}  // namespace
}  // namespace prostm
