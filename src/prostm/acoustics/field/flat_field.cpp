#include "prostm/acoustics/field/flat_field.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

namespace prostm {
namespace {

constexpr int kTaps = 16;
constexpr int kBefore = kTaps / 2 - 1;        // points of the interpolation before the cell's own
constexpr double kBandwidthTimesStep = 0.97;  // (A24): an error of 2e-6 along each axis
constexpr double kNear = 50e-3;               // distance to transducers below which step is 1 [m]
constexpr double kGrazing = 0.05;             // cosine below which a beam may be cut off [1]
constexpr int kLargestStep = 64;
constexpr std::size_t kMostValues = std::size_t{1} << 28;  // pressures kept at once, 1 GB

using Weights = Eigen::Matrix<float, kTaps, 1>;
using Course = Eigen::Map<Eigen::VectorXf>;

/// Lagrange's weights at fraction `share` between point kBefore and the next.
Weights weights_at(double share) {
  Weights out;
  for (int i = 0; i < kTaps; ++i) {
    double weight = 1.0;
    for (int j = 0; j < kTaps; ++j) {
      if (j != i) weight *= (kBefore + share - j) / (i - j);
    }
    out[i] = static_cast<float>(weight);
  }
  return out;
}

/// The computed points: every step-th of the raster, and some around it.
struct Coarse {
  Coarse(const FlatRaster& raster, int by)
      : step(by), rows((raster.rows - 1) / by + kTaps), cols((raster.cols - 1) / by + kTaps) {
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) {
        points.p_D.push_back(raster.at(by * (row - kBefore), by * (col - kBefore)));
        points.normal.push_back(raster.normal);
      }
    }
    for (int phase = 0; phase < by; ++phase) {
      weights.push_back(weights_at(static_cast<double>(phase) / by));
    }
  }
  const Weights& weights_of(int cell) const {
    return weights[static_cast<std::size_t>(cell % step)];
  }

  int step, rows, cols;
  SurfacePoints points;
  std::vector<Weights> weights;  // for each position of a cell between two points
};

/// Returns the largest difference between two transducers' wave vectors along the plane at a point
/// [rad/m], the spatial bandwidth of the pressure. Infinity where the field is not band-limited.
double bandwidth_at(const PackedArray& packed, const Vec3& point, const FlatRaster& raster) {
  const double pitch = raster.right.norm();
  std::vector<Vec2> along;
  for (std::size_t n = 0; n < packed.transducers(); ++n) {
    const Vec3 d = point - packed.array.position[n];
    const double r = d.norm();
    if (r < kNear || d.dot(packed.array.normal[n]) < kGrazing * r)
      return std::numeric_limits<double>::infinity();
    along.emplace_back(d.dot(raster.right) / (r * pitch), d.dot(raster.down) / (r * pitch));
  }
  double square = 0.0;
  for (std::size_t i = 0; i < along.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      square = std::max(square, (along[i] - along[j]).squaredNorm());
  }
  return packed.wave.number * std::sqrt(square);
}

/// @param from the first course; each begins `stride` values after the one before.
void interpolate(const float* from, std::size_t stride, const Weights& weights, Course to) {
  const Eigen::Map<const Eigen::MatrixXf, 0, Eigen::OuterStride<>> courses(
      from, to.size(), kTaps, Eigen::OuterStride<>(static_cast<Eigen::Index>(stride)));
  to.noalias() = courses * weights;
}

/// The pressure of all samples along one column of cells, at every step-th row.
class Column {
 public:
  Column(const Coarse& coarse, std::size_t samples)
      : samples_(samples),
        values_(static_cast<std::size_t>(coarse.rows) * samples),
        course_(samples) {}

  void load(const std::vector<float>& table, const Coarse& coarse, int col) {
    for (int row = 0; row < coarse.rows; ++row) {
      const auto from = static_cast<std::size_t>(row * coarse.cols + col / coarse.step);
      interpolate(table.data() + from * samples_, samples_, coarse.weights_of(col),
                  course_at(values_.data() + static_cast<std::size_t>(row) * samples_));
    }
  }
  /// Interpolates at a row of cells; valid until the next call.
  std::span<const float> at(const Coarse& coarse, int row) {
    const auto from = static_cast<std::size_t>(row / coarse.step);
    Course here = course_at(course_.data());
    interpolate(values_.data() + from * samples_, samples_, coarse.weights_of(row), here);
    here = here.cwiseMax(0.0F);
    return course_;
  }

 private:
  Course course_at(float* data) const { return {data, static_cast<Eigen::Index>(samples_)}; }

  std::size_t samples_;
  std::vector<float> values_, course_;
};

}  // namespace

int flat_step(const PackedArray& packed, const FlatRaster& raster, std::size_t samples) {
  const auto count = [&](int by) {
    return static_cast<std::size_t>((raster.rows - 1) / by + kTaps) *
           static_cast<std::size_t>((raster.cols - 1) / by + kTaps);
  };
  const auto saves = [&](int by) {
    return 2 * count(by) <
           static_cast<std::size_t>(raster.rows) * static_cast<std::size_t>(raster.cols);
  };
  if (!saves(kLargestStep)) return 1;
  constexpr int kLooks = 5;  // along each edge
  double bandwidth = 0.0;
  for (int j = 0; j < kLooks; ++j) {
    for (int i = 0; i < kLooks; ++i) {
      const double row = (raster.rows - 1.0) * j / (kLooks - 1),
                   col = (raster.cols - 1.0) * i / (kLooks - 1);
      bandwidth = std::max(bandwidth, bandwidth_at(packed, raster.at(row, col), raster));
    }
  }
  const double cells = kBandwidthTimesStep / (bandwidth * raster.right.norm());
  const int step = static_cast<int>(std::clamp(cells, 1.0, 1.0 * kLargestStep));
  return step > 1 && saves(step) && count(step) * samples <= kMostValues ? step : 1;
}

LoopPressure flat_loop_pressure(const PackedArray& packed, const Medium& medium,
                                const LoopBasis& basis, const FlatRaster& raster,
                                std::span<const std::size_t> cells, int frames, WorkerPool& pool) {
  const int step = flat_step(packed, raster, basis.samples);
  const auto width = static_cast<std::size_t>(raster.cols);
  if (step == 1) {
    SurfacePoints points;
    for (const std::size_t cell : cells) {
      points.p_D.push_back(
          raster.at(static_cast<double>(cell / width), static_cast<double>(cell % width)));
      points.normal.push_back(raster.normal);
    }
    return loop_pressure(packed, medium, basis, points, frames, pool);
  }
  validate_frames(frames, basis.samples);
  const Coarse coarse(raster, step);
  // one frame per sample
  const std::size_t samples = basis.samples;
  const std::vector<float> table =
      loop_pressure(packed, medium, basis, coarse.points, static_cast<int>(samples), pool).frame;
  std::vector<std::vector<std::size_t>> in_column(width);  // indices in `cells`
  for (std::size_t i = 0; i < cells.size(); ++i) in_column[cells[i] % width].push_back(i);
  LoopPressure out(cells.size(), frames);
  std::vector<Column> scratch(static_cast<std::size_t>(pool.threads()), Column(coarse, samples));
  std::atomic<int> next{0};
  pool.run(pool.threads(), [&](int thread) {
    Column& mine = scratch[static_cast<std::size_t>(thread)];
    for (int col = next++; col < raster.cols; col = next++) {
      mine.load(table, coarse, col);
      for (const std::size_t i : in_column[static_cast<std::size_t>(col)])
        out.take(i, mine.at(coarse, static_cast<int>(cells[i] / width)));
    }
  });
  return out;
}

}  // namespace prostm
