/// The answer about a machine, from trials that held their rates or did not.

#include "prostm/pipeline/machine_check.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "prostm/pipeline/machine.hpp"

namespace prostm {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Five seconds of the i-th setup.
Trial trial(std::size_t i, bool holds) {
  Trial trial;
  trial.setup = checked_setups()[i];
  RunSummary& s = trial.summary;
  s.seconds = s.took = 5.0;
  s.world_steps = holds ? 250 : 200;
  s.skipped_world_steps = 250 - s.world_steps;
  s.plans = s.world_steps / 2;
  s.world.p50 = 9.1e-3;
  s.world.p99 = 14e-3;
  s.plan.p50 = 2.1e-3;
  s.plan.p99 = 3e-3;
  trial.verdict = verdict_of(s, {});
  return trial;
}

TEST(MachineCheck, BeginsWithTheDefaultsAndGetsCheaper) {
  const auto setups = checked_setups();
  const PipelineSettings defaults;
  EXPECT_EQ(setups.front().cells, defaults.fluid.cells);
  EXPECT_EQ(setups.front().preset, defaults.plan.preset);
  for (std::size_t i = 1; i < setups.size(); ++i) EXPECT_LE(setups[i].cells, setups[i - 1].cells);
}

TEST(MachineCheck, TellsTheSlackOfTheDefaults) {
  const std::vector<Trial> trials = {trial(0, true)};
  const MachineAnswer answer = answer_of(trials);
  EXPECT_TRUE(answer.defaults_hold);
  EXPECT_THAT(
      answer.sentences,
      ElementsAre("This machine holds 50 steps and 25 plans a second with the defaults "
                  "(--grid 64 --preset best).",
                  "Slack: a step of the smoke takes 9.1 ms at the median and 14.0 ms at the "
                  "99th percentile, of 20; a plan takes 2.1 and 3.0 ms, of 40."));
}

TEST(MachineCheck, TellsWhatToUseInstead) {
  const std::vector<Trial> trials = {trial(0, false), trial(1, false), trial(2, true)};
  const MachineAnswer answer = answer_of(trials);
  EXPECT_FALSE(answer.defaults_hold);
  ASSERT_TRUE(answer.use);
  EXPECT_EQ(answer.use->cells, 48);
  EXPECT_THAT(answer.sentences,
              ElementsAre(AllOf(StartsWith("This machine does not hold 50 steps and 25 plans"),
                                HasSubstr("it does with --grid 48 --preset best: use these")),
                          StartsWith("Slack: ")));
}

TEST(MachineCheck, TellsThatNothingHolds) {
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < checked_setups().size(); ++i) trials.push_back(trial(i, false));
  const MachineAnswer answer = answer_of(trials);
  EXPECT_FALSE(answer.use);
  EXPECT_THAT(answer.sentences, ElementsAre(HasSubstr("not even with --grid 32 --preset fast")));
  EXPECT_THAT(answer_of({}).sentences, ElementsAre(StartsWith("Nothing was tried")));
}

TEST(MachineCheck, LooksAtTheMachine) {
  const Machine machine = look_at_machine(0.05);
  EXPECT_GE(machine.cores, 1);
  EXPECT_FALSE(machine.vectors.empty());
  EXPECT_GT(machine.sleep_late.n, 0u);
  EXPECT_GE(machine.sleep_late.p50, 0.0);
}

}  // namespace
}  // namespace prostm
