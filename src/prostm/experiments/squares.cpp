/// Skin velocity under squares of 1 and 3 cm.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "prostm/core/units.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::experiments {
namespace {

constexpr double kShown[] = {2, 4, 6, 8, 10, 12};

double value_at(const std::vector<double>& map, const Palm& palm, const Vec2& x) {
  // bilinear
  const double c = x.x() / palm.patch.cell + 0.5 * (palm.patch.cols - 1);
  const double r = x.y() / palm.patch.cell + 0.5 * (palm.patch.rows - 1);
  const int i = static_cast<int>(c), j = static_cast<int>(r);
  const double s = c - i, t = r - j;
  const auto at = [&](int row, int col) {
    return map[static_cast<std::size_t>(row * palm.patch.cols + col)];
  };
  return (1 - t) * ((1 - s) * at(j, i) + s * at(j, i + 1)) +
         t * ((1 - s) * at(j + 1, i) + s * at(j + 1, i + 1));
}

Look look_at(const std::vector<double>& map, const Palm& palm, double side) {
  Look look;
  const Lap lap = square_lap(side);
  constexpr int kPlaces = 200;
  for (int k = 0; k < kPlaces; ++k) {
    look.outline += value_at(map, palm, lap(static_cast<double>(k) / kPlaces)) / kPlaces;
  }
  look.middle = value_at(map, palm, Vec2::Zero()) / look.outline;
  const double most = *std::max_element(map.begin(), map.end());
  const double inner = 0.25 * side;
  double area = 0.0;
  for (int j = 1; j + 1 < palm.patch.rows; ++j) {
    for (int i = 1; i + 1 < palm.patch.cols; ++i) {
      const auto c = static_cast<std::size_t>(j * palm.patch.cols + i);
      if (map[c] > 0.5 * most) area += palm.patch.cell * palm.patch.cell;
      if (palm.at(j, i).cwiseAbs().maxCoeff() > inner) continue;
      look.inside = std::max(look.inside, map[c] / most);
      bool highest = true;
      for (const int step : {1, palm.patch.cols - 1, palm.patch.cols, palm.patch.cols + 1}) {
        const auto d = static_cast<std::size_t>(step);
        highest = highest && map[c] >= map[c - d] && map[c] >= map[c + d];
      }
      look.peak_inside = look.peak_inside || highest;
    }
  }
  look.half_width = std::sqrt(area);
  return look;
}

/// Rms and largest velocity of the skin over a lap in every cell [m/s].
struct VelocityMaps {
  std::vector<double> rms, largest;
};
VelocityMaps velocity_maps(const StmField& field, const Palm& palm, SkinResponse& response,
                           double side, double speed) {
  const double period = 4.0 * side / speed;
  const std::vector<double> pressure = field.pressure(square_lap(side), period, false);
  response.prepare(period, StmField::kSamples);
  response.respond({period, StmField::kSamples, pressure});
  VelocityMaps maps{std::vector<double>(palm.cells()), std::vector<double>(palm.cells(), 0.0)};
  rms_velocity(response, maps.rms);
  for (int k = 0; k < StmField::kSamples; ++k) {
    std::vector<double> now(palm.cells(), 0.0);
    for (int n = 1; n <= response.harmonics(); ++n) {
      const double omega = 2.0 * kPi * response.frequency(n);
      const auto turn =
          std::polar(omega, 2.0 * kPi * (n * k % StmField::kSamples) / StmField::kSamples);
      const auto w = response.displacement(n);
      for (std::size_t c = 0; c < now.size(); ++c) {
        now[c] -= w[c].real() * turn.imag() + w[c].imag() * turn.real();
      }
    }
    for (std::size_t c = 0; c < now.size(); ++c) {
      maps.largest[c] = std::max(maps.largest[c], std::abs(now[c]));
    }
  }
  return maps;
}

FieldMap map_of(const std::vector<double>& values, const Palm& palm, double side, double speed,
                const Look& look) {
  FieldMap map{fmt::format("{:.0f} cm, {:.0f} m/s", 100.0 * side, speed),
               fmt::format("middle over outline {:.2f}", look.middle),
               palm.patch.rows,
               palm.patch.cols,
               palm.patch.cell,
               values};
  for (int k = 0; k < 4; ++k) map.outline.push_back(square_lap(side)(0.25 * k));
  return map;
}

}  // namespace

std::vector<SquareLooks> square_looks(double side, std::span<const double> speeds, Skins skins,
                                      const Step& step) {
  const Palm palm;
  const StmField field(usx_array(), palm);
  std::vector<SquareLooks> out;
  for (const SkinSettings& skin : skins) {
    SkinResponse response(SkinModel(skin), palm.patch);
    SquareLooks& looks = out.emplace_back();
    for (const double speed : speeds) {
      const VelocityMaps maps = velocity_maps(field, palm, response, side, speed);
      looks.rms.push_back(look_at(maps.rms, palm, side));
      looks.largest.push_back(look_at(maps.largest, palm, side));
      step();
    }
  }
  return out;
}

void draw_squares(const std::string& path) {
  const Palm palm;
  const StmField field(usx_array(), palm);
  SkinResponse response(SkinModel(SkinSettings()), palm.patch);
  MapFigure picture{"Skin velocity (rms) under squares", "of the largest", 6, {}};
  for (const double side : kSquareSides) {
    for (const double speed : kShown) {
      const std::vector<double> rms = velocity_maps(field, palm, response, side, speed).rms;
      picture.maps.push_back(map_of(rms, palm, side, speed, look_at(rms, palm, side)));
    }
  }
  draw_maps(picture, path);
}

}  // namespace prostm::experiments
