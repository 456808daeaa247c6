/// The kernels that read a target and find close samples, compared with plain code.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"
#include "prostm/plan/detail/fit/raster/distances.hpp"
#include "prostm/plan/detail/fit/spacing.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"
#include "prostm/plan/detail/validity.hpp"
#include "support/load.hpp"

namespace prostm::planning {
namespace {

/// Returns a raster of any shape with holes in its skin, and with weights in half of the cases.
TargetField random_raster(Random& random) {
  TargetField field;
  field.resize(1 + random.below(40), 1 + random.below(40));
  field.cell = random.uniform(5e-4, 5e-3);
  for (std::size_t i = 0; i < field.size(); ++i) {
    field.skin[i] = random.uniform() < 0.7 ? 1 : 0;
    field.pressure[i] = random.uniform() < 0.8 ? random.uniform(0.0, 100.0) : 0.0;
  }
  field.skin[0] = 1;
  field.pressure[0] = 100.0;
  if (random.below(2) == 0) return field;
  for (std::size_t i = 0; i < field.size(); ++i) field.weight.push_back(random.uniform(0.1, 1.0));
  return field;
}

/// Sums over a block of cells.
struct Block {
  double weight = 0.0, pressure = 0.0, x = 0.0, y = 0.0, count = 0.0;
};
using Tile = std::array<Block, 8>;

/// Returns the tiles with skin, summed cell by cell.
std::vector<Tile> tiles_of(const TargetField& field, double maximum, int factor) {
  std::optional<CellWeights> weights;
  if (!field.weight.empty()) weights.emplace(field, maximum);
  const int across = (field.cols + 4 * factor - 1) / (4 * factor);
  const int down = (field.rows + 2 * factor - 1) / (2 * factor);
  std::vector<Tile> tiles(static_cast<std::size_t>(across * down));
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      if (field.skin[i] == 0) continue;
      const int r = row / factor, c = col / factor;
      Block& b = tiles[static_cast<std::size_t>(r / 2 * across + c / 4)]
                      [static_cast<std::size_t>(r % 2 * 4 + c % 4)];
      const double w = weights ? (*weights)[i] : 1.0;
      b.weight += w;
      b.count += 1.0;
      b.pressure += w * field.pressure[i] / maximum;
      b.x += w * col * kMmPerMetre * field.cell;
      b.y += w * row * kMmPerMetre * field.cell;
    }
  }
  std::erase_if(tiles, [](const Tile& tile) {
    return std::ranges::all_of(tile, [](const Block& b) { return b.weight == 0.0; });
  });
  return tiles;
}

TEST(CellTiles, MatchThePlainAverageOfBlocks) {
  Random random(1);
  CellTiles cells(1600);
  for (std::uint64_t n = 0; n < test::reduced(5000); ++n) {
    const TargetField field = random_raster(random);
    const double cell = kMmPerMetre * field.cell,
                 area = cell * cell / static_cast<double>(kUnitArea);
    const int wanted = 1 + random.below(9);
    cells.set(field, 100.0, wanted * cell);
    const int factor = std::min(wanted, std::max(field.rows, field.cols));
    const std::vector<Tile> expected = tiles_of(field, 100.0, factor);
    ASSERT_EQ(cells.tiles().size(), expected.size());
    double peak = 0.0, square = 0.0;
    for (std::size_t t = 0; t < expected.size(); ++t) {
      const CellTile& tile = cells.tiles()[t];
      for (std::size_t c = 0; c < 8; ++c) {
        const Block& b = expected[t][c];
        ASSERT_NEAR(tile.weight[c], b.weight * area, 1e-6 * b.weight * area);
        ASSERT_LE(std::hypot(tile.x[c] - tile.centre_x, tile.y[c] - tile.centre_y),
                  tile.radius * 1.00001F + 1e-4F);
        if (b.weight == 0.0) continue;
        const double pressure = b.pressure / b.weight, mean = b.weight / b.count;
        ASSERT_NEAR(tile.x[c], b.x / b.weight, 1e-5 * (1.0 + b.x / b.weight));
        ASSERT_NEAR(tile.y[c], b.y / b.weight, 1e-5 * (1.0 + b.y / b.weight));
        ASSERT_NEAR(tile.pressure[c], pressure, 1e-6);
        ASSERT_NEAR(cells.mean_weight(t, c), mean, 1e-6 * mean);
        peak = std::max(peak, pressure * mean);
        square += b.weight * area * pressure * pressure;
      }
    }
    ASSERT_NEAR(cells.peak(), peak, 1e-6 * peak);
    ASSERT_NEAR(cells.square_norm(), square, 1e-5 * square);
  }
}

TEST(NodePairs, MatchThePlainSearch) {
  Random random(2);
  NodePairs pairs;
  for (std::uint64_t n = 0; n < test::reduced(3000); ++n) {
    alignas(64) NodeArray x{}, y{};
    const auto nodes = static_cast<std::size_t>(1 + random.below(200));
    for (std::size_t i = 0; i < nodes; ++i) {
      x[i] = static_cast<float>(random.uniform(-60.0, 60.0));
      y[i] = static_cast<float>(random.uniform(-60.0, 60.0));
    }
    const auto distance = static_cast<float>(random.uniform(1.0, 40.0));
    pairs.set(x, y, nodes, distance);
    std::size_t found = 0;
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t b = a + 1; b < nodes; ++b) {
        const float apart = std::hypot(x[a] - x[b], y[a] - y[b]);
        const bool listed =
            found < pairs.size() && pairs[found].first == a && pairs[found].second == b;
        if (listed) ++found;
        if (std::abs(apart - distance) > 1e-4F) {
          ASSERT_EQ(listed, apart < distance) << a << " " << b << " of " << nodes;
        }
      }
    }
    ASSERT_EQ(found, pairs.size());
  }
}

/// Returns loops that may be long, irregular and crossing.
std::vector<Vec2> random_loops(Random& random, int paths, int samples) {
  std::vector<Vec2> x;
  for (int k = 0; k < paths; ++k) {
    const Vec2 centre(random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0));
    const double size = random.uniform(3.0, 30.0), roughness = random.uniform(0.0, 0.6);
    for (int i = 0; i < samples; ++i) {
      const double angle = 2.0 * kPi * i / samples;
      const double radius = size * (1.0 + roughness * random.uniform(-1.0, 1.0));
      x.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
  }
  return x;
}

TEST(Spacing, LeavesNoCrossingAndNothingTooClose) {
  Random random(3);
  SpacingRule rule;
  rule.spacing = 7.8;
  rule.along = 17.2;
  rule.least_length = 35.0;
  SpacingScratch scratch;
  int as_they_were = 0;
  for (std::uint64_t n = 0; n < test::reduced(3000); ++n) {
    const int paths = 1 + random.below(kMaxPaths), samples = 12 + 4 * random.below(5);
    std::vector<Vec2> x = random_loops(random, paths, samples);
    rule.most_length.fill(random.uniform(60.0, 150.0));
    const std::vector<Vec2> before = x;
    const int kept = make_spaced(x, samples, rule, scratch);
    ASSERT_GE(kept, 1);
    ASSERT_LE(kept, paths);
    const auto size = static_cast<std::size_t>(samples);
    x.resize(static_cast<std::size_t>(kept) * size);
    as_they_were += x == before ? 1 : 0;
    ASSERT_EQ(count_near_pairs(x, samples, rule), 0);
    for (std::size_t begin = 0; begin < x.size(); begin += size) {
      const std::span<const Vec2> loop = std::span(x).subspan(begin, size);
      ASSERT_TRUE(is_simple(loop));
      ASSERT_LE(loop_length(loop), rule.most_length[begin / size] * (1.0 + 1e-9));
      for (std::size_t other = 0; other < begin; other += size) {
        ASSERT_EQ(count_crossings(std::span(x).subspan(other, size), loop), 0);
      }
    }
  }
  EXPECT_GT(as_they_were, 0);
  EXPECT_LT(as_they_were, static_cast<int>(test::reduced(3000)));
}

}  // namespace
}  // namespace prostm::planning
