#include "prostm/study/analysis/percepts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace prostm {
namespace {

constexpr double kPressure = 0.1;  // for a focal point [Pa]

/// Flat skin 0.2 m above the array.
TargetFrame flat_skin() {
  TargetFrame frame;
  TargetField& skin = frame.patches.emplace_back();
  skin.cell = 5.625e-3;
  skin.resize(34, 34);
  skin.origin = Vec2::Constant(-16.5 * skin.cell);
  std::ranges::fill(skin.skin, std::uint8_t{1});
  return frame;
}

/// A palm joint above the middle of the array, fingers towards +y.
Pose palm_up(double x, double y) {
  Pose X_DH = Pose::Identity();
  X_DH.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  X_DH.translation() = Vec3(x, y, 0.2);
  return X_DH;
}

/// Two focal points of AM side by side, at this distance [m].
StimulusPercept two_points(StimulusFeeler& feeler, double apart) {
  Plan plan;
  for (const double x : {-0.5 * apart, 0.5 * apart})
    plan.foci.push_back({0, Vec2(x, 0.0), kPressure});
  return feeler.feel(plan, flat_skin(), palm_up(0.0, -0.025));
}

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

TEST(Percepts, TwoPointsAreDistinguishedAsByPeople) {
  StimulusFeeler feeler(PipelineSettings{}, kPressure, kStudySound);
  const Percept merged = two_points(feeler, 0.015).skin, apart = two_points(feeler, 0.045).skin,
                threshold = two_points(feeler, 0.0323).skin;
  const TemplateObserver observer(merged, apart, {kTouchNoise, kStrengthNoise});
  // people: less than 5 % "two" at 15 mm, 84 % at 45 mm
  EXPECT_NEAR(observer.d_prime(), 1.645 + 0.994, 0.05);
  // and half of the answers at 32.3 mm, which the model was not fitted to
  const double two = normal_cdf(observer.evidence(threshold) - observer.evidence(merged) - 1.645);
  RecordProperty("two_at_threshold", std::to_string(two));
  EXPECT_NEAR(two, 0.5, 0.15);
}

TEST(Percepts, PositionsAreRelativeToTheHand) {
  TargetField skin = flat_skin().patches.front();
  std::vector<double> map(skin.size(), 1.0);
  const Percept flat = HandPlaces(skin, palm_up(0.0, -0.02)).of(map);
  // a Gaussian preserves its integral: 1 where the hand is far from the raster's edge
  EXPECT_NEAR(*std::ranges::max_element(flat), 1.0, 1e-3);
  map.assign(skin.size(), 0.0);
  map[skin.index(20, 12)] = 2.0;
  const Percept spot = HandPlaces(skin, palm_up(0.0, 0.0)).of(map);
  skin.origin += Vec2(0.013, -0.007);
  const Percept moved = HandPlaces(skin, palm_up(0.013, -0.007)).of(map);
  for (std::size_t i = 0; i < spot.size(); ++i) EXPECT_NEAR(moved[i], spot[i], 1e-12);
  skin.skin[skin.index(20, 12)] = 0;
  for (const double v : HandPlaces(skin, palm_up(0.0, 0.0)).of(map)) EXPECT_EQ(v, 0.0);
}

TEST(Percepts, NothingIsFeltWithoutPressure) {
  StimulusFeeler feeler(PipelineSettings{}, kPressure, kStudySound);
  Plan silent;
  silent.foci.push_back({0, Vec2::Zero(), 0.001 * kPressure});
  for (const Plan& plan : {Plan{}, silent}) {
    const StimulusPercept felt = feeler.feel(plan, flat_skin(), palm_up(0.0, 0.0));
    EXPECT_EQ(felt.strength, 0.0);
    EXPECT_EQ(felt.skin.size(), felt.field.size());
    EXPECT_EQ(*std::ranges::max_element(felt.skin), 0.0);
  }
}

TEST(Percepts, StrengthAndMapsAreProportionalToPressure) {
  StimulusFeeler feeler(PipelineSettings{}, kPressure, kStudySound);
  Plan plan;
  plan.foci.push_back({0, Vec2(0.01, 0.0), 0.2 * kPressure});
  const StimulusPercept weak = feeler.feel(plan, flat_skin(), palm_up(0.0, 0.0));
  plan.foci[0].pressure = 0.8 * kPressure;
  const StimulusPercept strong = feeler.feel(plan, flat_skin(), palm_up(0.0, 0.0));
  // the skin is linear, and the effect of the slew limit and the silent level is small
  EXPECT_NEAR(strong.strength / weak.strength, 4.0, 0.1);
  const auto largest = [](const Percept& p) { return *std::ranges::max_element(p); };
  EXPECT_NEAR(largest(strong.field) / largest(weak.field), 4.0, 1e-9);
  EXPECT_NEAR(largest(strong.skin) / largest(weak.skin), 4.0, 0.1);
}

TEST(Percepts, AHandFeelsTheSameInARepeatedScene) {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  const ModelHand hand = random_hand(5);
  int calls = 0;
  const auto twice = [&] { return ++calls % 2 != 0; };
  const ScenePercepts first = feel_scene(settings, "four-plumes", hand, kStudySound, 4, {}, twice),
                      again = feel_scene(settings, "four-plumes", hand, kStudySound, 4, {}, twice);
  ASSERT_EQ(first.am.size(), 2U);  // as the callback requested
  ASSERT_EQ(first.pro_stm.size(), 2U);
  EXPECT_GT(first.am[0].strength, 0.0);
  EXPECT_EQ(first.am[1].skin, again.am[1].skin);
  EXPECT_EQ(first.pro_stm[1].field, again.pro_stm[1].field);
  EXPECT_NE(first.am[0].skin, first.pro_stm[0].skin);
}

TEST(Percepts, AVariationChangesWhatItNames) {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  const ModelHand hand = random_hand(5);
  const auto feel = [&](const SceneVariation& variation) {
    return feel_scene(settings, "four-plumes", hand, kStudySound, 1, variation,
                      [] { return true; });
  };
  const ScenePercepts usual = feel({});
  const StimulusPercept &am = usual.am[0], &pro_stm = usual.pro_stm[0];

  // another place of the hand: the stimulus is as strong, and elsewhere
  const ScenePercepts placed = feel({.place = 0.01, .turn = 0.17});
  EXPECT_EQ(placed.am[0].strength, am.strength);
  EXPECT_EQ(placed.pro_stm[0].strength, pro_stm.strength);
  EXPECT_NE(placed.am[0].skin, am.skin);
  EXPECT_NE(placed.pro_stm[0].skin, pro_stm.skin);

  const ScenePercepts opposed = feel({.opposed_foci = true});
  EXPECT_NE(opposed.am[0].skin, am.skin);
  EXPECT_EQ(opposed.pro_stm[0].skin, pro_stm.skin);
}

TEST(Percepts, WavesReflectAtTheEdgesOfTheSkin) {
  StimulusFeeler endless(PipelineSettings(), kPressure, kStudySound),
      ends(PipelineSettings(), kPressure, kStudySound, SkinEdges::Reflecting);
  const StimulusPercept usual = two_points(endless, 0.04), reflected = two_points(ends, 0.04);
  EXPECT_NE(reflected.skin, usual.skin);
  EXPECT_EQ(reflected.field, usual.field);
  EXPECT_NEAR(reflected.strength / usual.strength, 1.0, 0.5);
}

TEST(Percepts, HandsDifferWithinBounds) {
  double least = 2.0, most = 0.0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const ModelHand hand = random_hand(seed);
    least = std::min(least, hand.size);
    most = std::max(most, hand.size);
    EXPECT_GE(hand.tremor, 0.015);
    EXPECT_LE(hand.tremor, 0.04);
  }
  EXPECT_NEAR(least, 0.85, 0.02);
  EXPECT_NEAR(most, 1.15, 0.02);
}

}  // namespace
}  // namespace prostm
