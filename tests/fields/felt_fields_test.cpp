#include "prostm/fields/felt_fields.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace prostm::fields {
namespace {

std::vector<FeltKind> all_kinds() {
  std::vector<FeltKind> all(kFeltKinds.begin(), kFeltKinds.end());
  all.insert(all.end(), kUnseenKinds.begin(), kUnseenKinds.end());
  all.insert(all.end(), kDrawnKinds.begin(), kDrawnKinds.end());
  return all;
}

/// Pearson's correlation over the skin of two fields on one raster.
double correlation(const TargetField& a, const TargetField& b) {
  double n = 0.0, ma = 0.0, mb = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a.skin[c] == 0) continue;
    n += 1.0;
    ma += a.pressure[c];
    mb += b.pressure[c];
  }
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a.skin[c] == 0) continue;
    const double da = a.pressure[c] - ma / n, db = b.pressure[c] - mb / n;
    aa += da * da;
    bb += db * db;
    ab += da * db;
  }
  return ab / std::sqrt(aa * bb);
}

TEST(FeltFields, AreValidTargetsThatVaryOverTheSkin) {
  for (const FeltKind kind : all_kinds()) {
    for (const Outline outline : {Outline::Hand, Outline::Palm}) {
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const TargetField field = felt_field(kind, seed, outline);
        ASSERT_NO_THROW(validate(field));
        EXPECT_DOUBLE_EQ(max_pressure(field), 1.0);
        double skin = 0.0, strong = 0.0, weak = 0.0;
        for (std::size_t c = 0; c < field.size(); ++c) {
          if (field.skin[c] == 0) continue;
          skin += 1.0;
          strong += field.pressure[c] > 0.5 ? 1.0 : 0.0;
          weak += field.pressure[c] < 0.3 ? 1.0 : 0.0;
        }
        EXPECT_GT(strong, 3.0) << to_string(kind) << ", " << seed;
        EXPECT_LT(strong, 0.75 * skin) << to_string(kind) << ", " << seed;
        EXPECT_GT(weak, 0.1 * skin) << to_string(kind) << ", " << seed;
      }
    }
  }
}

TEST(FeltFields, OutlinesHaveTheStatedSizes) {
  const TargetField hand = felt_field(FeltKind::Plume, 1, Outline::Hand),
                    palm = felt_field(FeltKind::Plume, 1, Outline::Palm);
  EXPECT_NEAR(hand.cols * hand.cell, 0.105, 1e-12);
  EXPECT_NEAR(hand.rows * hand.cell, 0.180, 1e-12);
  EXPECT_NEAR(palm.rows * palm.cell, 0.096, 1e-12);
  const auto area = [](const TargetField& f) {
    return static_cast<double>(std::count(f.skin.begin(), f.skin.end(), 1)) * f.cell * f.cell;
  };
  EXPECT_NEAR(area(palm), 3.14159 * 0.038 * 0.048, 2e-4);
  EXPECT_GT(area(hand), 0.011);
  EXPECT_LT(area(hand), 0.014);
}

TEST(FeltFields, DependOnTheSeedAlone) {
  for (const FeltKind kind : all_kinds()) {
    const TargetField one = felt_field(kind, 3, Outline::Hand);
    EXPECT_EQ(one.pressure, felt_field(kind, 3, Outline::Hand).pressure);
    EXPECT_LT(correlation(one, felt_field(kind, 4, Outline::Hand)), 0.995) << to_string(kind);
  }
}

TEST(FeltFields, KindsHaveDistinctNames) {
  std::set<std::string> names;
  for (const FeltKind kind : all_kinds()) names.insert(to_string(kind));
  EXPECT_EQ(names.size(), all_kinds().size());
}

}  // namespace
}  // namespace prostm::fields
