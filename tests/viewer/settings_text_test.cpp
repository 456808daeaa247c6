/// A run's settings in the form of a settings file.

#include "prostm/viewer/detail/settings_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "prostm/io/settings_file.hpp"

namespace prostm {
namespace {

using viewer::changed_settings;

TEST(SettingsText, IsEmptyForTheDefaults) {
  EXPECT_EQ(changed_settings({}), "");
}

TEST(SettingsText, ContainsOnlyDifferences) {
  PipelineSettings s;
  s.plan.preset = Preset::Fast;
  s.fluid.jet_speed = 1.5;
  s.scripted_hand.still = true;
  EXPECT_EQ(changed_settings(s),
            "[scripted_hand]\nstill = true\n\n[fluid]\njet_speed = 1.5\n\n"
            "[plan]\npreset = \"fast\"\n");
}

TEST(SettingsText, LeavesOutTheBudgetOfRealTime) {
  PipelineSettings s;
  for (const Preset preset : {Preset::Best, Preset::Felt}) {
    s.plan.preset = preset;
    s.plan.budget = 0.0;
    const std::string text = changed_settings(s);
    set_live_budget(s);
    EXPECT_GT(s.plan.budget, 0.0);
    EXPECT_EQ(changed_settings(s), text);
    s.plan.budget *= 2.0;
    EXPECT_NE(changed_settings(s), text);
  }
}

TEST(SettingsText, ReadsBackExactly) {
  PipelineSettings s;
  s.scene = "four-plumes";
  s.array = "an \"array\".json";
  s.plan.sigma = 0.1 * 0.087;
  s.plan.paths = s.am.foci = s.emit.foci = 7;
  s.emit.switch_at = SwitchAt::Now;
  s.array_width = true;
  PipelineSettings read;
  settings_from_toml(changed_settings(s), "a test", settings_groups(read));
  EXPECT_EQ(settings_to_json(settings_groups(std::as_const(read))),
            settings_to_json(settings_groups(std::as_const(s))));
}

}  // namespace
}  // namespace prostm
