/// The gate in the pipeline: its sentences for hands that a study has to turn away.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm {
namespace {

/// A study hand that a test modifies.
class Changed final : public HandSource {
 public:
  using Change = std::function<void(Hand&)>;
  explicit Changed(Change change) : change_(std::move(change)), hand_(make_study_hand({})) {}
  void sample(double time, HandFrame& out) override {
    hand_->sample(time, out);
    for (Hand& hand : out.hands) change_(hand);
  }

 private:
  Change change_;
  std::unique_ptr<HandSource> hand_;
};

/// Returns the gate's result after a second of four-plumes.
GateResult judged(std::unique_ptr<HandSource> hands) {
  PipelineSettings settings;
  settings.scene = "four-plumes";
  settings.fluid.cells = 48;
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Pipeline pipeline(settings, std::move(hands));
  for (int step = 1; step <= 50; ++step) pipeline.step(0.02);
  return pipeline.plan().gate.value();
}

Changed::Change turn(double angle) {
  return [angle](Hand& hand) {
    const Eigen::AngleAxisd turned(angle, Vec3::UnitX());
    const Vec3 centre = hand.position[kPalm];
    for (Vec3& p : hand.position) p = centre + turned * (p - centre);
  };
}

/// The fist of the scripted hand.
Changed::Change close() {
  return [](Hand& hand) {
    HandFrame closed;
    make_scripted_hand({}, {})->sample(0.77 * 20.0, closed);
    hand = closed.hands.at(0);
  };
}

// the study hand is in the tracker's frame, whose x axis is the device's
Changed::Change shift(double x) {
  return [x](Hand& hand) {
    for (Vec3& p : hand.position) p.x() += x;
  };
}

TEST(StudyGate, RejectsAFistATiltedHandAndOneOffThePlumes) {
  const GateResult beside = judged(std::make_unique<Changed>(shift(0.04)));
  EXPECT_FALSE(beside.pass);
  EXPECT_EQ(beside.finding.problem, GateProblem::Beside);
  EXPECT_THAT(sentence(beside), testing::HasSubstr("40 mm to the left"));

  const GateResult tilted = judged(std::make_unique<Changed>(turn(0.4)));
  EXPECT_EQ(tilted.finding.problem, GateProblem::Tilted) << sentence(tilted);

  const GateResult bent = judged(std::make_unique<Changed>(close()));
  EXPECT_EQ(bent.finding.problem, GateProblem::Bent) << sentence(bent);
}

TEST(StudyGate, GivesNoVerdictWithoutAStimulus) {
  PipelineSettings settings;
  settings.scene = "still-air";
  settings.fluid.cells = 32;
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Pipeline pipeline(settings, make_study_hand({}));
  for (int step = 1; step <= 4; ++step) pipeline.step(0.02);
  EXPECT_FALSE(pipeline.plan().gate);
}

}  // namespace
}  // namespace prostm
