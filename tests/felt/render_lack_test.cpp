#include "prostm/felt/render_lack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/fields/fields.hpp"

namespace prostm {
namespace {

constexpr double kBlur = 8.5;  // [mm]

/// (Q5) and (Q4) as sums over all pairs of blocks.
struct Slow {
  explicit Slow(const FeltCells& blocks) : cells(blocks.cells()) {
    for (const FeltCells::Cell& cell : cells) target.push_back(cell.pressure);
    const int reach = static_cast<int>(std::ceil(4.0 * kBlur / blocks.pitch()));
    for (const FeltCells::Cell& x : cells) {
      std::vector<double>& row = weight.emplace_back();
      double sum = 0.0;
      for (const FeltCells::Cell& y : cells) {
        const int down = y.row - x.row, across = y.col - x.col;
        const bool near = std::abs(down) <= reach && std::abs(across) <= reach;
        const double away = std::hypot(down, across) * blocks.pitch() / kBlur;
        row.push_back(near ? y.area * std::exp(-0.5 * away * away) : 0.0);
        sum += row.back();
      }
      for (double& w : row) w /= sum;
    }
  }
  std::vector<double> blurred(const std::vector<double>& field) const {
    std::vector<double> out;
    for (const std::vector<double>& row : weight) {
      out.push_back(0.0);
      for (std::size_t j = 0; j < row.size(); ++j) out.back() += row[j] * field[j];
    }
    return out;
  }
  double lack(const std::vector<double>& wanted, const std::vector<double>& field) const {
    double both = 0.0, own = 0.0, square = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      both += cells[i].area * wanted[i] * field[i];
      own += cells[i].area * field[i] * field[i];
      square += cells[i].area * wanted[i] * wanted[i];
      mean += cells[i].area * wanted[i];
    }
    return (square - both * both / own) / (square - mean * mean);
  }
  std::vector<FeltCells::Cell> cells;
  std::vector<double> target;
  std::vector<std::vector<double>> weight;
};

TEST(RenderLack, MatchesTheSumsOverAllBlocks) {
  Random random(5);
  FeltCells blocks(kFeltCells);
  RenderLack<double> lack(kFeltCells);
  RenderLack<float> short_lack(kFeltCells);
  for (const fields::Pattern pattern : fields::kPatterns) {
    for (const int raster : {25, 54, 80}) {  // one or more cells per block
      const TargetField target = fields::make(pattern, 10, raster);
      blocks.set(target, max_pressure(target));
      lack.set(blocks);
      short_lack.set(blocks);
      const Slow slow(blocks);
      std::vector<double> field;
      for (const double wanted : slow.target) field.push_back(wanted + random.uniform(0.01, 0.5));
      const auto n = static_cast<Eigen::Index>(field.size());
      const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(field.data(), n);
      Eigen::VectorXd pull(n);
      Eigen::VectorXf short_pull(n);
      const double expected = slow.lack(slow.blurred(slow.target), slow.blurred(field)) +
                              0.3 * slow.lack(slow.target, field);
      EXPECT_NEAR(lack.of(at, 0.3, pull), expected, 1e-12);
      EXPECT_NEAR(static_cast<double>(short_lack.of(at.cast<float>(), 0.3F, short_pull)), expected,
                  1e-4 * expected);
      EXPECT_LT((short_pull.cast<double>() - pull).norm(), 1e-3 * pull.norm());
      for (Eigen::Index i = 0; i < n; i += 7) {
        Eigen::VectorXd before = at, after = at, other(n);
        before[i] -= 1e-6;
        after[i] += 1e-6;
        const double difference = (lack.of(after, 0.3, other) - lack.of(before, 0.3, other)) / 2e-6;
        ASSERT_NEAR(pull[i], difference, 1e-8);
      }
    }
  }
}

}  // namespace
}  // namespace prostm
