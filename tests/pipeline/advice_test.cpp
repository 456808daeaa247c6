/// Advice when rates are missed.

#include "prostm/pipeline/realtime/advice.hpp"

#include <gmock/gmock.h>

#include <string>

#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/pipeline/smoke/scene_grids.hpp"

namespace prostm {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

PipelineSettings in(const std::string& scene) {
  PipelineSettings settings;
  settings.scene = scene;
  return settings;
}
std::string said(const WorkTime& work, const PipelineSettings& settings) {
  return sentence(advise(work, settings), settings);
}

// at any speed of the machine
TEST(Advice, SuggestsOnlyGridsThatKeepTheStimulus) {
  for (const Scene& scene : scenes()) {
    PipelineSettings settings = in(std::string(scene.name));
    for (const int cells : {32, 40, 48, 56, 64, 96, 160}) {
      settings.fluid.cells = cells;
      for (double step = 1e-3; step < 1.0; step *= 1.3) {
        const Advice advice = advise({step, 1e-3}, settings);
        if (advice.kind == AdviceKind::Grid) {
          EXPECT_LT(advice.cells, cells);
          EXPECT_EQ(grid_effect(settings, advice.cells), GridEffect::Keeps) << scene.name;
        } else {
          EXPECT_EQ(advice.kind, AdviceKind::NoOption);
        }
      }
    }
  }
}

TEST(Advice, SuggestsTheFinestGridThatFits) {
  EXPECT_EQ(said({24e-3, 2e-3}, in("one-plume")),
            "Use --grid 48, which keeps the stimulus of one-plume, or close other programs.");
  EXPECT_EQ(said({80e-3, 2e-3}, in("one-plume")),
            "Use --grid 32, which keeps the stimulus of one-plume, or close other programs.");
  EXPECT_EQ(said({17e-3, 2e-3}, in("four-plumes")),
            "Use --grid 56, which keeps the stimulus of four-plumes, or close other programs.");
  EXPECT_EQ(said({24e-3, 2e-3}, in("ring")), "Use --grid 48, or close other programs.");
}

TEST(Advice, ReportsThatNoOptionHelps) {
  EXPECT_EQ(said({24e-3, 2e-3}, in("four-plumes")),
            "No option is fast enough and keeps the stimulus of four-plumes: close other programs, "
            "or use a faster machine.");
  EXPECT_THAT(said({1.0, 2e-3}, in("ring")), HasSubstr("No option is fast enough: close"));
}

TEST(Advice, ReportsWhatIsUnknown) {
  PipelineSettings settings = in("four-plumes");
  settings.study_hand.height = 0.18;
  EXPECT_THAT(
      said({17e-3, 2e-3}, settings),
      AllOf(HasSubstr("Close other programs"), HasSubstr("is not known with these settings"),
            HasSubstr("--grid 56"), Not(HasSubstr("Use --grid"))));
}

TEST(Advice, OtherProgramsAreTheFirstRemedyIfTheWorkFits) {
  EXPECT_EQ(said({8e-3, 2e-3}, in("four-plumes")),
            "Close other programs, or use --grid 56, which keeps the stimulus of four-plumes.");
  PipelineSettings coarse = in("four-plumes");
  coarse.fluid.cells = 56;
  EXPECT_EQ(said({8e-3, 2e-3}, coarse), "Close other programs.");
}

TEST(Advice, SlowPlansHaveTheirOwnAdvice) {
  PipelineSettings settings = in("four-plumes");
  EXPECT_EQ(said({8e-3, 39e-3}, settings), "Use --preset fast.");
  settings.plan.preset = Preset::Fast;
  EXPECT_EQ(said({8e-3, 39e-3}, settings), "Use fewer --paths.");
  settings.plan.paths = 1;
  EXPECT_THAT(said({8e-3, 39e-3}, settings), HasSubstr("No option is fast enough"));
}

TEST(Advice, RecordedPartsAreDroppedFirst) {
  PipelineSettings settings = in("four-plumes");
  settings.fluid_pressure.parts = true;
  EXPECT_THAT(said({24e-3, 2e-3}, settings), HasSubstr("parts = false"));
}

// a run that is evaluated repeatedly, with varying times
TEST(Adviser, KeepsItsSuggestionWhileTheSettingsStay) {
  Adviser adviser;
  PipelineSettings settings = in("one-plume");
  EXPECT_EQ(adviser.advise({24e-3, 2e-3}, settings).cells, 48);
  EXPECT_EQ(adviser.advise({80e-3, 2e-3}, settings).cells, 48);
  EXPECT_EQ(adviser.advise({8e-3, 2e-3}, settings).cells, 48);
  EXPECT_EQ(adviser.advise({8e-3, 39e-3}, settings).kind, AdviceKind::FastPreset);
  EXPECT_EQ(adviser.advise({24e-3, 2e-3}, settings).cells, 48);
  EXPECT_TRUE(adviser.is_for(settings));
  settings.fluid.cells = 48;
  EXPECT_FALSE(adviser.is_for(settings));
  EXPECT_EQ(adviser.advise({24e-3, 2e-3}, settings).cells, 32);
}

}  // namespace
}  // namespace prostm
