/// The textbook planner is compiled once per kind of machine and selected at run time.

#include "prostm/textbook/textbook.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

namespace prostm {
namespace {

/// Allows only this target during its lifetime.
class Only {
 public:
  explicit Only(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~Only() { hwy::SetSupportedTargetsForTest(0); }
  Only(const Only&) = delete;
  Only& operator=(const Only&) = delete;
};

TargetField two_blobs() {
  TargetField field;
  field.resize(24, 30);
  field.cell = 5e-3;
  field.skin.assign(field.size(), 1);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Vec2 x = field.position(i);
    field.pressure[i] = std::exp(-(x - Vec2(0.06, 0.06)).squaredNorm() / 1e-3) +
                        std::exp(-(x - Vec2(0.10, 0.04)).squaredNorm() / 3e-4);
  }
  return field;
}

TEST(Textbook, PlansTheSameOnEveryKindOfMachine) {
  const TargetField field = two_blobs();
  Plan expected;
  PlanStats stats;
  ASSERT_EQ(textbook::plan(field, {}, expected, stats), PlanStatus::Planned);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const Only only(target);
    Plan plan;
    ASSERT_EQ(textbook::plan(field, {}, plan, stats), PlanStatus::Planned);
    ASSERT_EQ(plan.paths.size(), expected.paths.size());
    for (std::size_t k = 0; k < plan.paths.size(); ++k) {
      EXPECT_EQ(plan.paths[k].points, expected.paths[k].points) << hwy::TargetName(target);
      EXPECT_EQ(plan.paths[k].pressure, expected.paths[k].pressure) << hwy::TargetName(target);
    }
  }
}

}  // namespace
}  // namespace prostm
