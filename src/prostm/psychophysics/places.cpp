#include "prostm/psychophysics/places.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

Vec2 place_of(const SkinPatch& patch, int row, int col) {
  return patch.cell * Vec2(col - 0.5 * (patch.cols - 1), row - 0.5 * (patch.rows - 1));
}

std::size_t index_of(const SkinPatch& patch, int row, int col) {
  return static_cast<std::size_t>(row * patch.cols + col);
}

}  // namespace

std::vector<double> blurred(const SkinPatch& patch, std::span<const double> map, double sigma) {
  const int reach = static_cast<int>(std::ceil(4.0 * sigma / patch.cell));
  std::vector<double> taps;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    taps.push_back(std::exp(-0.5 * std::pow(i * patch.cell / sigma, 2)));
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  const auto tap = [&](int i) { return taps[static_cast<std::size_t>(i + reach)]; };
  std::vector<double> across(map.size()), out(map.size());
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      for (int k = std::max(0, i - reach); k <= std::min(patch.cols - 1, i + reach); ++k)
        across[index_of(patch, j, i)] += tap(k - i) * map[index_of(patch, j, k)];
    }
  }
  for (int j = 0; j < patch.rows; ++j) {
    for (int k = std::max(0, j - reach); k <= std::min(patch.rows - 1, j + reach); ++k) {
      for (int i = 0; i < patch.cols; ++i)
        out[index_of(patch, j, i)] += tap(k - j) * across[index_of(patch, k, i)];
    }
  }
  return out;
}

double value_at(const SkinPatch& patch, std::span<const double> map, const Vec2& place) {
  const double x = place.x() / patch.cell + 0.5 * (patch.cols - 1);
  const double y = place.y() / patch.cell + 0.5 * (patch.rows - 1);
  const int col = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  double out = 0.0;
  for (int j = row; j <= row + 1; ++j) {
    for (int i = col; i <= col + 1; ++i) {
      if (j < 0 || i < 0 || j >= patch.rows || i >= patch.cols) continue;
      out += (1.0 - std::abs(x - i)) * (1.0 - std::abs(y - j)) * map[index_of(patch, j, i)];
    }
  }
  return out;
}

std::vector<double> at_grid(const SkinPatch& patch, std::span<const double> map, double spacing,
                            const Vec2& shift) {
  const int sideways = static_cast<int>(0.5 * (patch.cols - 1) * patch.cell / spacing);
  const int upwards = static_cast<int>(0.5 * (patch.rows - 1) * patch.cell / spacing);
  std::vector<double> out;
  for (int j = -upwards; j <= upwards; ++j) {
    for (int i = -sideways; i <= sideways; ++i)
      out.push_back(value_at(patch, map, spacing * Vec2(i, j) - shift));
  }
  return out;
}

Vec2 centroid(const SkinPatch& patch, std::span<const double> map) {
  Vec2 sum = Vec2::Zero();
  double all = 0.0;
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      const double v = map[index_of(patch, j, i)];
      sum += v * place_of(patch, j, i);
      all += v;
    }
  }
  return all > 0.0 ? Vec2(sum / all) : Vec2(Vec2::Zero());
}

}  // namespace prostm
