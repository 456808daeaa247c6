/// A focal point on a straight line: the extent of its waves ahead and behind.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/experiments/wake.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::experiments {
namespace {

constexpr double kShown[] = {2, 4, 6, 7, 8, 10};
const SkinPatch kPatch{101, 151, 2e-3};
constexpr int kFocusRow = 50, kFocusCol = 110;

/// Returns the pressure of the array's focus at 200 mm in the moving patch, as for a focus at rest:
/// unlike the other experiments, without the loss due to the transducers' lag, (A9).
std::vector<double> focus() {
  constexpr int kCells = 41;  // the focus and its first side lobes
  const Palm palm{SkinPatch{kCells, kCells, kPatch.cell}};
  const std::vector<double> square = foci_pressure(usx_array(), palm, {Vec2::Zero()});
  std::vector<double> pressure(static_cast<std::size_t>(kPatch.rows * kPatch.cols), 0.0);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const int row = kFocusRow + j - kCells / 2, col = kFocusCol + i - kCells / 2;
      pressure[static_cast<std::size_t>(row * kPatch.cols + col)] =
          square[static_cast<std::size_t>(j * kCells + i)];
    }
  }
  return pressure;
}

/// Evaluates the patch from column `first_col` on. The patch extends 80 mm ahead of the focus and
/// 220 mm behind it.
Reach reach_of(const std::vector<double>& velocity, int first_col = 0) {
  double energy[2] = {0.0, 0.0}, moment[2] = {0.0, 0.0};
  for (int j = 0; j < kPatch.rows; ++j) {
    for (int i = first_col; i < kPatch.cols; ++i) {
      const double v = velocity[static_cast<std::size_t>(j * kPatch.cols + i)];
      const double x = kPatch.cell * (i - kFocusCol);
      const int side = x < 0.0 ? 1 : 0;
      energy[side] += v * v;
      moment[side] += v * v * x * x;
    }
  }
  return {std::sqrt(moment[0] / energy[0]), std::sqrt(moment[1] / energy[1])};
}

std::vector<SpeedReach> reaches_of(const std::vector<double>& pressure,
                                   std::span<const double> speeds, Skins skins, const Step& step) {
  const int even_col = 2 * kFocusCol - kPatch.cols + 1;
  std::vector<SpeedReach> out;
  for (const double speed : speeds) {
    SpeedReach& at = out.emplace_back();
    at.speed = speed;
    for (std::size_t s = 0; s < skins.size(); ++s) {
      const auto velocity = wake_velocity(SkinModel(skins[s]), kPatch, pressure, speed);
      const Reach reach = reach_of(velocity);
      at.ratios.push_back(reach.behind / reach.ahead);
      if (s != skins.size() / 2) continue;
      at.nominal = reach;
      at.even = reach_of(velocity, even_col);
    }
    step();
  }
  return out;
}

}  // namespace

std::vector<SpeedReach> line_reaches(std::span<const double> speeds, Skins skins,
                                     const Step& step) {
  return reaches_of(focus(), speeds, skins, step);
}

void draw_lines(const std::string& path) {
  const std::vector<double> pressure = focus();
  MapFigure picture{"Skin velocity (magnitude) under a focal point that moves to the right",
                    "of the largest",
                    3,
                    {}};
  for (const double speed : kShown) {
    FieldMap map{fmt::format("{:.0f} m/s", speed),
                 "",
                 kPatch.rows,
                 kPatch.cols,
                 kPatch.cell,
                 wake_velocity(SkinModel(SkinSettings()), kPatch, pressure, speed)};
    const Reach reach = reach_of(map.values);
    for (double& v : map.values) v = std::abs(v);
    map.note =
        fmt::format("{:.0f} mm ahead, {:.0f} mm behind", 1e3 * reach.ahead, 1e3 * reach.behind);
    picture.maps.push_back(map);
  }
  draw_maps(picture, path);
}

}  // namespace prostm::experiments
