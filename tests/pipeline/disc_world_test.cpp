// A world of another program, chosen by name from that program's table.
#include "pipeline/disc_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::array<WorldKind, 2> kKinds = {world_kinds().front(), test::kDisc};

PipelineSettings settings_of(const char* world) {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  settings.scripted_hand.still = true;
  choose_world(world_named(world, kKinds), settings);
  return settings;
}

Pipeline pipeline_of(const PipelineSettings& settings) {
  SimulatedArraySettings array;
  array.realtime = false;
  return {settings,
          make_scripted_hand(settings.scripted_hand, settings.track),
          std::make_shared<Mute>(),
          std::make_unique<SimulatedArray>(array, settings.transducers, Medium{}),
          nullptr,
          kKinds};
}

struct Onlooker final : RunObserver {
  bool on_plan(const WorldFrame&, const PlanFrame& plan) override {
    paths += plan.status == PlanStatus::Planned ? std::ssize(plan.plan.paths) : 0;
    return true;
  }
  bool on_progress(double) override { return true; }
  std::int64_t paths = 0;
};

RunSummary stepped(const char* world, Onlooker& onlooker) {
  const PipelineSettings settings = settings_of(world);
  Pipeline pipeline = pipeline_of(settings);
  return run(pipeline, settings, {.seconds = 1.0, .mode = RunMode::Stepped}, onlooker);
}

TEST(DiscWorld, IsChosenByNameAndPlanned) {
  EXPECT_EQ(settings_of("disc").scene, "disc");
  Onlooker onlooker;
  const RunSummary s = stepped("disc", onlooker);
  EXPECT_EQ(s.world_steps, 50);
  EXPECT_GE(s.plans, 20);
  EXPECT_GE(onlooker.paths, s.plans);
  EXPECT_EQ(s.full_scale_pressure, settings_of("disc").plan.gain * 0.5);
}

TEST(DiscWorld, SummaryHasOnlyItsOwnQuantity) {
  Onlooker onlooker;
  const RunSummary disc = stepped("disc", onlooker);
  ASSERT_EQ(disc.world_quantities.size(), 1U);
  EXPECT_STREQ(disc.world_quantities[0].name, "mean_pressed_area_cm2");
  EXPECT_GT(disc.world_means[0], 6.0);
  EXPECT_LT(disc.world_means[0], 14.0) << "π (2 cm)² = 12.6 cm²";
  const RunSummary smoke = stepped("smoke", onlooker);
  ASSERT_EQ(smoke.world_quantities.size(), 2U);
  EXPECT_STREQ(smoke.world_quantities[0].name, "mean_relative_divergence");
  EXPECT_STREQ(smoke.world_quantities[1].name, "mean_pressure_error");
  EXPECT_GT(smoke.world_means[0], 0.0);
}

TEST(DiscWorld, ScenesBelongToTheirWorld) {
  PipelineSettings settings = settings_of("disc");
  settings.scene = "one-plume";
  EXPECT_THAT([&] { pipeline_of(settings); },
              ThrowsMessage<std::invalid_argument>(
                  "scene \"one-plume\" is unknown: it must be disc or wide-disc"));
  settings = settings_of("smoke");
  settings.scene = "disc";
  EXPECT_THAT([&] { pipeline_of(settings); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("it must be one-plume, ")));
  settings.world = "disk";
  EXPECT_THAT([&] { pipeline_of(settings); },
              ThrowsMessage<std::invalid_argument>(
                  "world \"disk\" is unknown: it must be smoke or disc; did you mean \"disc\"?"));
  settings.world = "disc";
  EXPECT_THROW(make_world(settings, *std::make_unique<WorkerPool>(1)), std::invalid_argument)
      << "not in the table of this build";
}

TEST(DiscWorld, ReconfigureChangesSceneAndWorld) {
  PipelineSettings settings = settings_of("disc");
  Pipeline pipeline = pipeline_of(settings);
  pipeline.step(0.02);
  settings.scene = "wide-disc";
  pipeline.reconfigure(settings);
  EXPECT_EQ(pipeline.world_stage().world().full_scale_pressure(), 0.25);
  choose_world(kKinds[0], settings);
  pipeline.reconfigure(settings);
  EXPECT_EQ(pipeline.world_stage().world().quantities().size(), 2U);
  settings.world = "none";
  EXPECT_THROW(pipeline.reconfigure(settings), std::invalid_argument);
  while (!pipeline.step(0.02)) {
  }
  EXPECT_EQ(pipeline.settings().world, "smoke");
}

TEST(WorldKinds, StudiesListOnlyOtherWorldsThanTheDefault) {
  PipelineSettings settings;
  const auto first_of = [](const std::vector<SettingsGroup>& groups) {
    return std::string(setting_rows(groups.front().read).front().setting.name);
  };
  EXPECT_EQ(first_of(settings_groups(std::as_const(settings))), "world");
  EXPECT_EQ(first_of(study_settings_groups(settings)), "scene");
  settings.world = "disc";
  EXPECT_EQ(first_of(study_settings_groups(settings)), "world");
}

TEST(WorldKinds, AreListedForHelp) {
  EXPECT_EQ(world_choices(), "smoke (default; jets of smoke)");
  EXPECT_EQ(world_choices(kKinds),
            "smoke (default; jets of smoke) or disc (a disc that presses evenly)");
  const std::string smoke =
      "one-plume (default), two-plumes, three-plumes, four-plumes, ring, pulsing, wind, or "
      "still-air";
  EXPECT_EQ(scene_choices(), smoke);
  EXPECT_EQ(scene_choices(kKinds), smoke + "; with --world disc: disc (default) or wide-disc");
  const PipelineSettings defaults;
  EXPECT_EQ(defaults.world, world_kinds().front().name);
  EXPECT_EQ(defaults.scene, world_kinds().front().scenes().front().name);
}

}  // namespace
}  // namespace prostm
