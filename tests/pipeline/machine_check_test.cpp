/// The verdict on a machine, from trials that met their rates or did not.

#include "prostm/pipeline/realtime/machine_check.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "prostm/pipeline/realtime/machine.hpp"
#include "prostm/pipeline/smoke/scene_grids.hpp"

namespace prostm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Five seconds with one set of options.
MachineTrial trial(const CheckedSetup& setup, bool holds) {
  MachineTrial trial;
  trial.setup = setup;
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

/// The verdict on a machine that is just fast enough for this grid and preset.
MachineAnswer of_machine(int cells, Preset preset, const std::vector<std::string>& scenes) {
  std::vector<MachineTrial> trials;
  for (const CheckedSetup& setup : checked_setups(scenes)) {
    const bool holds = setup.cells <= cells && (setup.preset == preset || preset == Preset::Best);
    trials.push_back(trial(setup, holds));
    if (holds) break;
  }
  return answer_of(trials, scenes);
}

TEST(MachineCheck, StartsWithTheDefaultsAndGetsCheaper) {
  for (const auto& scenes : {stimulus_scenes(), {"four-plumes"}, {"ring"}}) {
    const auto setups = checked_setups(scenes);
    const PipelineSettings defaults;
    EXPECT_EQ(setups.front().cells, defaults.fluid.cells);
    EXPECT_EQ(setups.front().preset, defaults.plan.preset);
    for (std::size_t i = 1; i < setups.size(); ++i) EXPECT_LE(setups[i].cells, setups[i - 1].cells);
  }
}

TEST(MachineCheck, TriesOnlyGridsThatKeepTheStimulus) {
  for (const std::string& scene : stimulus_scenes()) {
    PipelineSettings settings;
    settings.scene = scene;
    for (const CheckedSetup& setup : checked_setups(std::vector{scene}))
      EXPECT_EQ(grid_effect(settings, setup.cells), GridEffect::Keeps) << scene;
  }
}

TEST(MachineCheck, ReportsTheSlackOfTheDefaults) {
  const MachineAnswer answer = of_machine(64, Preset::Best, stimulus_scenes());
  EXPECT_TRUE(answer.defaults_hold);
  ASSERT_TRUE(answer.use);
  EXPECT_EQ(answer.use->cells, 64);
  EXPECT_THAT(
      answer.sentences,
      ElementsAre("This machine holds 50 steps and 25 plans a second with the defaults "
                  "(--grid 64 --preset best).",
                  "Slack: a step of the smoke takes 9.1 ms at the median and 14.0 ms at the "
                  "99th percentile, of 20; a plan takes 2.1 and 3.0 ms, of 40."));
}

TEST(MachineCheck, ReportsTheOptionsForEachScene) {
  const MachineAnswer answer = of_machine(48, Preset::Best, stimulus_scenes());
  EXPECT_FALSE(answer.defaults_hold);
  EXPECT_FALSE(answer.use) << "no option suits all scenes";
  EXPECT_THAT(
      answer.sentences,
      ElementsAre(
          "This machine does not hold 50 steps and 25 plans a second with the defaults, but "
          "it does with --grid 48 --preset best.",
          "Use --grid 48 --preset best in one-plume, two-plumes and three-plumes, whose "
          "stimulus it keeps.",
          HasSubstr("No option holds the rates and keeps the stimulus in four-plumes: close"),
          StartsWith("Slack: ")));
  for (const SceneAnswer& of : answer.scenes) {
    EXPECT_EQ(of.use.has_value(), of.scene != "four-plumes") << of.scene;
  }
}

// on machines of any speed
TEST(MachineCheck, EveryOptionKeepsTheStimulusOfItsScene) {
  for (const int cells : {20, 32, 40, 48, 56, 64}) {
    for (const SceneAnswer& of : of_machine(cells, Preset::Best, stimulus_scenes()).scenes) {
      if (!of.use) continue;
      PipelineSettings settings;
      settings.scene = of.scene;
      EXPECT_EQ(grid_effect(settings, of.use->cells), GridEffect::Keeps) << of.scene;
      EXPECT_LE(of.use->cells, cells);
    }
  }
}

TEST(MachineCheck, AnswersForOneScene) {
  const MachineAnswer answer = of_machine(56, Preset::Best, {"four-plumes"});
  ASSERT_TRUE(answer.use);
  EXPECT_EQ(answer.use->cells, 56);
  EXPECT_THAT(of_machine(48, Preset::Best, {"four-plumes"}).sentences,
              ElementsAre(HasSubstr("not even with --grid 56 --preset fast"),
                          HasSubstr("keeps the stimulus in four-plumes")));
  EXPECT_THAT(of_machine(40, Preset::Best, {"ring"}).sentences[1],
              "Use --grid 40 --preset best in ring.");
}

TEST(MachineCheck, ReportsThatNothingIsFastEnough) {
  const MachineAnswer answer = of_machine(0, Preset::Best, stimulus_scenes());
  EXPECT_FALSE(answer.use);
  EXPECT_THAT(answer.sentences,
              ElementsAre(HasSubstr("not even with --grid 32 --preset fast"),
                          HasSubstr("in one-plume, two-plumes, three-plumes and four-plumes")));
  EXPECT_THAT(answer_of({}, {}).sentences, ElementsAre(StartsWith("Nothing was tried")));
}

TEST(MachineCheck, InspectsTheMachine) {
  const Machine machine = look_at_machine(0.05);
  EXPECT_GE(machine.cores, 1);
  EXPECT_FALSE(machine.vectors.empty());
  EXPECT_GT(machine.sleep_late.n, 0u);
  EXPECT_GE(machine.sleep_late.p50, 0.0);
}

}  // namespace
}  // namespace prostm
