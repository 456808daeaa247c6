#include "prostm/fluid/fluid_pressure.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {

namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({.name = "pressure_of", .help = "the part of the pressure that is felt"}, s.part);
  v.field({.name = "parts", .help = "both parts stand in the targets beside what is felt"},
          s.parts);
  v.field({"offset", "m", 0.001, 0.05, "distance from the skin at which the pressure is read"},
          s.offset);
  v.field({"time_constant", "s", 0, 10, "time constant of the pressure's smoothing; 0: none"},
          s.time_constant);
}

}  // namespace

void FluidPressureSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void FluidPressureSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

FluidPressure::FluidPressure(const FluidPressureSettings& settings, const GridShape& grid)
    : settings_(settings), grid_(grid) {
  require_bounds(settings);
  if (settings.time_constant == 0.0) return;
  smoothed_.assign(grid.cell_count(), 0.0F);
  was_fluid_.assign(grid.cell_count(), 0);
  next_smoothed_ = smoothed_;
  next_was_fluid_ = was_fluid_;
}

void FluidPressure::move_to(const Vec3& p_DF) {
  const CellShift by = whole_cells(p_DF - grid_.p_DF, grid_.cell);
  grid_.p_DF = p_DF;
  if (smoothed_.empty() || by == CellShift{}) return;
  std::size_t c = 0;
  for (int k = by[2]; k < by[2] + grid_.nz; ++k) {
    for (int j = by[1]; j < by[1] + grid_.ny; ++j) {
      for (int i = by[0]; i < by[0] + grid_.nx; ++i, ++c) {
        const bool known =
            i >= 0 && j >= 0 && k >= 0 && i < grid_.nx && j < grid_.ny && k < grid_.nz;
        const std::size_t from = known ? grid_.cell_index(i, j, k) : 0;
        next_smoothed_[c] = smoothed_[from];
        next_was_fluid_[c] = known ? was_fluid_[from] : std::uint8_t{0};
      }
    }
  }
  smoothed_.swap(next_smoothed_);
  was_fluid_.swap(next_was_fluid_);
}

void FluidPressure::take(std::span<const float> pressure, std::span<const std::uint8_t> fluid_cells,
                         double dt) {
  fluid_ = fluid_cells;
  pressure_ = pressure;
  if (smoothed_.empty()) return;
  const auto share = static_cast<float>(1.0 - std::exp(-dt / settings_.time_constant));
  const float* now = pressure_.data();
  const std::uint8_t* known = was_fluid_.data();
  float* smoothed = smoothed_.data();
  for (std::size_t c = 0, count = smoothed_.size(); c < count; ++c) {
    // a cell that was not fluid before has no history
    const float weight = known[c] != 0 ? share : 1.0F;
    smoothed[c] += weight * (now[c] - smoothed[c]);
  }
  std::copy(fluid_.begin(), fluid_.end(), was_fluid_.begin());
  pressure_ = smoothed_;
}

void FluidPressure::sample(std::span<const Vec3> p_D, const Vec3& outside,
                           std::span<double> out) const noexcept {
  const Vec3 offset = settings_.offset * outside;
  for (std::size_t i = 0; i < p_D.size(); ++i) out[i] = at(p_D[i] + offset);
}

double FluidPressure::at(const Vec3& p_D) const {
  // trilinear between cell centres; cells inside a hand are left out and the weights renormalised
  const Vec3 q = (p_D - grid_.p_DF) / grid_.cell - Vec3::Constant(0.5);
  const int i = static_cast<int>(std::floor(q.x())), j = static_cast<int>(std::floor(q.y())),
            k = static_cast<int>(std::floor(q.z()));
  double sum = 0.0, weights = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int ci = i + (corner & 1), cj = j + (corner >> 1 & 1), ck = k + (corner >> 2);
    if (ci < 0 || cj < 0 || ck < 0 || ci >= grid_.nx || cj >= grid_.ny || ck >= grid_.nz) continue;
    const std::size_t c = grid_.cell_index(ci, cj, ck);
    if (fluid_[c] == 0) continue;
    const double weight =
        (1.0 - std::abs(q.x() - ci)) * (1.0 - std::abs(q.y() - cj)) * (1.0 - std::abs(q.z() - ck));
    sum += weight * static_cast<double>(pressure_[c]);
    weights += weight;
  }
  return weights > 1e-6 ? sum / weights : 0.0;
}

}  // namespace prostm
