/// A preset unknown to prostm: only its traits decide how paths are planned.

#include <gmock/gmock.h>

#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

/// One start, but as many points as preset best, and a budget.
constexpr PresetTraits kThrifty{.name = "thrifty",
                                .title = "Thrifty",
                                .search = PathSearch::Short,
                                .moves_fit_samples = true,
                                .halves_segments = true,
                                .live_budget = 2e-3};

PlanSettings with(const PresetTraits& traits) {
  PlanSettings settings;
  settings.own_preset = &traits;
  return settings;
}

TEST(OwnPreset, PlansByItsTraits) {
  const PlanSettings settings = with(kThrifty);
  for (const fields::Pattern pattern : fields::kPatterns) {
    const Plan plan = test::plan_of(settings, fields::make(pattern, 0));
    ASSERT_NO_FATAL_FAILURE(
        test::expect_valid_plan(plan, 2 * settings.fit_samples, settings.max_length()));
  }
}

TEST(OwnPreset, OnlyTheTraitsDistinguishPresets) {
  const TargetField field = fields::make(fields::kPatterns[1], 2);
  for (std::size_t i = 0; i < kPresetTraits.size(); ++i) {
    PlanSettings named;
    named.preset = static_cast<Preset>(i);
    const Plan expected = test::plan_of(named, field),
               plan = test::plan_of(with(kPresetTraits[i]), field);
    ASSERT_EQ(plan.paths.size(), expected.paths.size());
    for (std::size_t k = 0; k < plan.paths.size(); ++k) {
      EXPECT_EQ(plan.paths[k].points, expected.paths[k].points);
      EXPECT_EQ(plan.paths[k].pressure, expected.paths[k].pressure);
    }
  }
}

TEST(OwnPreset, AcceptsTheSettingsOfItsTraits) {
  PlanSettings settings = with(kThrifty);
  settings.budget = 1e-3;
  EXPECT_NO_THROW(validate(settings));
  constexpr PresetTraits kPlain{.name = "plain", .title = "Plain"};
  settings.own_preset = &kPlain;
  try {
    validate(settings);
    ADD_FAILURE() << "a budget was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("a budget is for presets best and felt, not plain"));
  }
}

// moving the points takes longer than a real-time run allows
TEST(PlanSettings, RejectPointsMovedByThePerceptWithABudget) {
  PlanSettings settings;
  settings.felt_weight = 0.9;
  settings.felt_points = true;
  EXPECT_NO_THROW(validate(settings));
  settings.budget = 8e-3;
  EXPECT_THROW(validate(settings), std::invalid_argument);
  settings.felt_points = false;
  EXPECT_NO_THROW(validate(settings));
}

TEST(Presets, AreListedByTheirTraits) {
  EXPECT_EQ(presets_with([](const PresetTraits& t) { return t.takes_budget(); }),
            "presets best and felt");
  EXPECT_EQ(presets_with([](const PresetTraits& t) { return t.is_fitted(); }),
            "presets best, fast, and felt");
  EXPECT_EQ(presets_with([](const PresetTraits& t) { return t.takes_felt_weight(); }),
            "presets best and fast");
  EXPECT_EQ(presets_with([](const PresetTraits&) { return true; }),
            "presets paper, paper-valid, best, fast, and felt");
  EXPECT_EQ(preset_choices(), "paper, paper-valid, best (default), fast, or felt");
}

}  // namespace
}  // namespace prostm
