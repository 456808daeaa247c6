#include <gtest/gtest.h>

#include <cmath>

#include "fields/fields.hpp"
#include "methods/comparison.hpp"
#include "support/load.hpp"

namespace prostm::bench {
namespace {

constexpr int kCells = 32;

TargetField target() {
  return fields::make(fields::Pattern::OnePlume, 50, kCells);
}

TEST(Ghosts, AreMaximaWhereNothingIsToBeFelt) {
  TargetField field = target();
  std::fill(field.skin.begin(), field.skin.end(), std::uint8_t{1});
  std::fill(field.pressure.begin(), field.pressure.end(), 0.0);
  field.pressure[field.index(8, 8)] = 1.0;
  std::vector<double> felt(field.size(), 0.0);
  EXPECT_EQ(ghosts_of(field, {std::vector<double>(field.size(), 1.0)}).largest, 1.0);
  felt[field.index(8, 8)] = 1.0;
  EXPECT_EQ(ghosts_of(field, felt).count, 0);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.0);
  felt[field.index(8, 9)] = 0.9;  // 5 mm away, and no maximum
  felt[field.index(9, 9)] = 0.9;
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.0);
  felt[field.index(24, 24)] = 0.6;
  felt[field.index(24, 8)] = 0.4;
  EXPECT_EQ(ghosts_of(field, felt).count, 1);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.6);
  field.skin[field.index(24, 24)] = 0;
  EXPECT_EQ(ghosts_of(field, felt).count, 0);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.4);
}

TEST(Rendering, ControlsMakeEqualWhatTheySay) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering best = renderer.render(Way::Best, field), am = renderer.render(Way::Am, field),
                  flat = renderer.render(Way::Flat, field);
  EXPECT_EQ(factor_for(Equal::Drive, am, best), 1.0);
  EXPECT_EQ(factor_for(Equal::Drive, flat, best), 0.0);
  EXPECT_EQ(factor_for(Equal::Power, flat, best), 0.0);
  EXPECT_DOUBLE_EQ(factor_for(Equal::Power, am, best) * am.mean_power, best.mean_power);
  for (const Rendering* r : {&best, &am, &flat}) {
    EXPECT_DOUBLE_EQ(factor_for(Equal::Percept, *r, best) * r->largest_percept,
                     best.largest_percept);
    EXPECT_DOUBLE_EQ(factor_for(Equal::Percept, best, best), 1.0);
  }
  // nothing is felt off the skin
  for (std::size_t c = 0; c < field.size(); ++c) {
    if (field.skin[c] == 0) {
      EXPECT_EQ(best.percept[c], 0.0);
    }
  }
}

TEST(Rendering, FlatHasNoSkillAndBestHas) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering flat = renderer.render(Way::Flat, field);
  EXPECT_NEAR(flat.envelope.skill_0, 0.0, 1e-9);
  EXPECT_GT(flat.intensity, 0.0);
  const Rendering best = renderer.render(Way::Best, field);
  EXPECT_GT(best.envelope.skill_8, 0.5);
  EXPECT_GT(best.mean_power, 1.0);
  EXPECT_LE(best.mean_power, 256.0);
  EXPECT_GT(best.field.largest, best.field.largest_mean);
}

}  // namespace
}  // namespace prostm::bench
