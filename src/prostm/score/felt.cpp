#include "prostm/score/felt.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"

namespace prostm {
namespace {

constexpr int kPart = kLoopUnit;          // samples per part of the loop, 0.2 ms at 40 kHz
constexpr double kGhostDistance = 10e-3;  // least distance of a ghost from cells with a target [m]
constexpr double kTargetShare =
    0.1;  // share of the target's maximum from which a cell has a target

/// Copies the pressures of a loop to the whole raster, part by part; 0 off the skin.
std::vector<double> on_raster(const TargetField& raster, const SkinSurface& skin,
                              const LoopPressure& pressure) {
  const auto parts = static_cast<std::size_t>(pressure.frames);
  std::vector<double> out(raster.size() * parts, 0.0);
  for (std::size_t m = 0; m < skin.cell.size(); ++m) {
    for (std::size_t k = 0; k < parts; ++k) {
      out[k * raster.size() + skin.cell[m]] = static_cast<double>(pressure.frame[m * parts + k]);
    }
  }
  return out;
}

bool is_beside(const TargetField& target, double nothing, int row, int col) {
  const int reach = static_cast<int>(std::floor(kGhostDistance / target.cell));
  for (int j = std::max(0, row - reach); j <= std::min(target.rows - 1, row + reach); ++j) {
    for (int i = std::max(0, col - reach); i <= std::min(target.cols - 1, col + reach); ++i) {
      const std::size_t cell = target.index(j, i);
      if (target.skin[cell] != 0 && target.pressure[cell] >= nothing &&
          std::hypot(j - row, i - col) * target.cell <= kGhostDistance) {
        return false;
      }
    }
  }
  return true;
}

bool is_local_maximum(const TargetField& raster, const std::vector<double>& map, int row, int col) {
  const double here = map[raster.index(row, col)];
  for (int j = std::max(0, row - 1); j <= std::min(raster.rows - 1, row + 1); ++j) {
    for (int i = std::max(0, col - 1); i <= std::min(raster.cols - 1, col + 1); ++i) {
      if (map[raster.index(j, i)] > here) return false;
    }
  }
  return here > 0.0;
}

}  // namespace

bool is_felt(const TargetField& raster, const LoopSamples& loop) {
  constexpr double kHighestRate = 100e3;                // [Hz]
  constexpr double kSmallest = 1e-4, kLargest = 20e-3;  // cells [m]
  constexpr int kMost = 128;                            // cells along an edge
  return loop.sample_rate <= kHighestRate && loop.samples >= 3 * kPart &&
         loop.samples <= kLongestFelt * loop.sample_rate &&
         std::max(raster.rows, raster.cols) <= kMost && raster.cell >= kSmallest &&
         raster.cell <= kLargest;
}

int felt_parts(const LoopSamples& loop) {
  return loop.samples / kPart;
}

FeltField felt_field(const TargetField& raster, const SkinMotion& motion) {
  FeltField out;
  out.percept.resize(raster.size());
  percept_map(motion, out.percept);
  for (std::size_t c = 0; c < raster.size(); ++c) {
    if (raster.skin[c] == 0) out.percept[c] = 0.0;
  }
  out.intensity = perceived_intensity(motion);
  out.largest = *std::max_element(out.percept.begin(), out.percept.end());
  return out;
}

std::vector<double> raster_pressure(const PackedArray& packed, const Medium& medium,
                                    const TargetField& raster, const LoopSamples& loop,
                                    const LoopDriveResult& drives, WorkerPool& pool) {
  const SkinSurface skin = skin_surface(raster);
  return on_raster(raster, skin,
                   loop_pressure(packed, medium, LoopBasis(packed, drives.output, pool),
                                 skin.points, felt_parts(loop), pool));
}

FeelingSkin::FeelingSkin(const TargetField& raster)
    : response_(SkinModel(SkinSettings()), {raster.rows, raster.cols, raster.cell}) {}

FeltField FeelingSkin::feel(const TargetField& raster, double period, int parts,
                            std::span<const double> pressure) {
  response_.prepare(period, parts);
  response_.respond({period, parts, pressure});
  return felt_field(raster, response_);
}

FeltField FeelingSkin::feel(const PackedArray& packed, const Medium& medium,
                            const TargetField& raster, const LoopSamples& loop,
                            const LoopDriveResult& drives, WorkerPool& pool) {
  return feel(raster, loop.samples / loop.sample_rate, felt_parts(loop),
              raster_pressure(packed, medium, raster, loop, drives, pool));
}

FeelingBoundedSkin::FeelingBoundedSkin(const TargetField& raster, const SkinSettings& settings)
    : skin_(SkinModel(settings), {raster.rows, raster.cols, raster.cell}, raster.skin) {}

FeltField FeelingBoundedSkin::feel(const TargetField& raster, double period, int parts,
                                   std::span<const double> pressure) {
  if (period != period_ || parts != parts_) {
    skin_.prepare(period, parts);
    period_ = period;
    parts_ = parts;
  }
  skin_.respond({period, parts, pressure});
  return felt_field(raster, skin_);
}

Ghosts ghosts_of(const TargetField& target, const std::vector<double>& percept) {
  const double nothing = kTargetShare * max_pressure(target);
  const double largest = *std::max_element(percept.begin(), percept.end());
  Ghosts out;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t cell = target.index(row, col);
      if (target.skin[cell] == 0 || !is_local_maximum(target, percept, row, col) ||
          !is_beside(target, nothing, row, col)) {
        continue;
      }
      out.largest = std::max(out.largest, percept[cell] / largest);
      out.count += percept[cell] > 0.5 * largest ? 1 : 0;
    }
  }
  return out;
}

}  // namespace prostm
