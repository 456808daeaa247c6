/// Cost of an array's field: rows of the propagation matrix, and the field of a whole loop compared
/// with direct matrix products by OpenBLAS.
///
/// usage: field_bench [--json FILE]

#ifdef PROSTM_WITH_OPENBLAS
#include <cblas.h>
#endif

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "prostm/acoustics/field/loop_field.hpp"
#include "prostm/acoustics/field/propagation_kernels.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/loop_drives.hpp"
#include "report.hpp"

namespace prostm {
namespace {

using bench::Row;

/// A raster of side × side points, 1.5 mm apart, 200 mm above the array.
std::vector<Vec3> raster(int side) {
  std::vector<Vec3> points;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      points.emplace_back(1.5e-3 * (i - 0.5 * (side - 1)), 1.5e-3 * (j - 0.5 * (side - 1)), 0.2);
    }
  }
  return points;
}

/// Adds the time per element of G [ns], measured in turn for the kernel, for the plain reference,
/// and for the floor, which only writes as many numbers.
void add_propagation_rows(int points, int repeats, std::vector<Row>& rows) {
  const PackedArray packed(usx_array(), Medium());
  std::vector<Vec3> at = raster(64);
  at.resize(static_cast<std::size_t>(points));
  std::vector<float> re(at.size() * packed.stride()), im(re.size());
  const int inner = std::max(1, 4096 / points);
  Distribution ours, plain, floor;
  for (int i = 0; i < repeats; ++i) {
    const auto time = [&](Distribution& out, int times, auto&& work) {
      const StageTimer timer;
      for (int k = 0; k < times; ++k) work(static_cast<float>(k));
      out.add(1e9 * timer.seconds() / (times * static_cast<double>(re.size())));
    };
    time(ours, inner, [&](float) { propagation_rows(packed, at, {}, re.data(), im.data()); });
    time(plain, std::max(1, inner / 16),
         [&](float) { propagation_rows_plain(packed, at, {}, re.data(), im.data()); });
    time(floor, inner, [&](float value) {
      std::fill(re.begin(), re.end(), value);
      std::fill(im.begin(), im.end(), value);
    });
  }
  const std::string name = "G, " + std::to_string(points) + " points x 256";
  rows.push_back({name, "ns", ours.summary(), "plain", plain.summary().p50});
  rows.push_back({name + ", only written", "ns", floor.summary(), "kernel", ours.summary().p50});
}

constexpr int kSamples = 800;  // 20 ms at 40 kHz
constexpr int kSide = 64;      // points along each edge of the raster

/// Returns the output of a USX's transducers over 20 ms of a plan of preset best with four paths.
LoopDrives gallery_drives(fields::Pattern pattern) {
  const TargetField target = fields::make(pattern, 0);
  Planner planner(PlanSettings(), target.size());
  Plan plan;
  PlanStats stats;
  planner.plan(target, plan, stats);
  TargetFrame frame;
  frame.patches.push_back(target);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  EmitSettings emit;
  for (const LiftedPath& path : lifted.paths) {
    for (const double p : path.pressure) {
      emit.full_scale_pressure = std::max(emit.full_scale_pressure, p);
    }
  }
  LoopDriveResult result;
  loop_drives(
      usx_array(), Medium(), loop_samples(lifted, emit, 40e3), LoopDriveSettings(),
      [](int, int) { return true; }, result);
  LoopDrives drives(result.output.rows(), kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    drives.col(k) = result.output.col(k % result.output.cols());
  }
  return drives;
}

/// Returns the raster's points, facing the array.
SurfacePoints surface() {
  SurfacePoints out;
  out.p_D = raster(kSide);
  out.normal.assign(out.p_D.size(), -Vec3::UnitZ());
  return out;
}

#ifdef PROSTM_WITH_OPENBLAS
/// The same results by direct products: a ready-made G in the precision of T times the drives, in
/// blocks of rows whose product stays in the cache; BLAS also sums the squares of each row.
template <class T>
class DirectProduct {
 public:
  DirectProduct(const PackedArray& packed, const SurfacePoints& at, const LoopDrives& drives)
      : points_(static_cast<int>(at.p_D.size())),
        n_(static_cast<int>(packed.transducers())),
        g_(at.p_D.size() * packed.transducers()),
        a_(static_cast<std::size_t>(n_) * kSamples),
        z_(static_cast<std::size_t>(kBlock) * kSamples) {
    for (std::size_t m = 0; m < at.p_D.size(); ++m) {
      for (std::size_t n = 0; n < packed.transducers(); ++n) {
        const Vec3 way = (at.p_D[m] - packed.array.position[n]).normalized();
        g_[m * packed.transducers() + n] =
            static_cast<std::complex<T>>(std::max(-way.dot(at.normal[m]), 0.0) *
                                         propagate(packed.array, packed.wave, n, at.p_D[m]));
      }
    }
    for (int n = 0; n < n_; ++n) {
      for (int k = 0; k < kSamples; ++k) {
        a_[static_cast<std::size_t>(n) * kSamples + static_cast<std::size_t>(k)] =
            static_cast<std::complex<T>>(drives(n, k));
      }
    }
  }

  void mean(double unit, std::vector<float>& out) {
    for (int first = 0; first < points_; first += kBlock) {
      multiply(first);
      for (int m = 0; m < kBlock; ++m) {
        const T* row =
            reinterpret_cast<const T*>(z_.data()) + static_cast<std::size_t>(m) * 2 * kSamples;
        out[static_cast<std::size_t>(first + m)] =
            static_cast<float>(unit / kSamples * square(row));
      }
    }
  }

  void envelope(double unit, std::vector<float>& out) {
    for (int first = 0; first < points_; first += kBlock) {
      multiply(first);
      for (int m = 0; m < kBlock; ++m) {
        const std::complex<T>* row = z_.data() + static_cast<std::size_t>(m) * kSamples;
        T most = 0;
        for (int k = 0; k < kSamples; ++k) most = std::max(most, std::norm(row[k]));
        out[static_cast<std::size_t>(first + m)] =
            static_cast<float>(unit * static_cast<double>(most));
      }
    }
  }

 private:
  static constexpr int kBlock = 256;
  void multiply(int first) {
    const std::complex<T> one(1), zero(0);
    const auto* from = g_.data() + static_cast<std::size_t>(first) * static_cast<std::size_t>(n_);
    if constexpr (sizeof(T) == 4) {
      cblas_cgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, kBlock, kSamples, n_, &one, from, n_,
                  a_.data(), kSamples, &zero, z_.data(), kSamples);
    } else {
      cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, kBlock, kSamples, n_, &one, from, n_,
                  a_.data(), kSamples, &zero, z_.data(), kSamples);
    }
  }
  static double square(const T* row) {
    if constexpr (sizeof(T) == 4) {
      return static_cast<double>(cblas_sdot(2 * kSamples, row, 1, row, 1));
    } else {
      return cblas_ddot(2 * kSamples, row, 1, row, 1);
    }
  }
  int points_, n_;
  std::vector<std::complex<T>> g_, a_, z_;
};

/// Returns the largest difference, relative to the largest value of `b`.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double worst = 0.0;
  float most = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i])));
    most = std::max(most, b[i]);
  }
  return worst / static_cast<double>(most);
}

/// Adds the time of a loop's field [ms] with this many threads, all patterns of the gallery,
/// measured in turn. Our code builds G; the products are given it.
void add_loop_rows(const std::vector<LoopDrives>& loops, int threads, std::vector<Row>& rows) {
  const PackedArray packed(usx_array(), Medium());
  const SurfacePoints at = surface();
  const double unit = radiation_pressure(1.0, Medium());
  WorkerPool pool(threads);
  openblas_set_num_threads(threads);
  Distribution mean, direct, envelope, direct_envelope, mean_error, envelope_error, rank;
  std::vector<float> expected(at.p_D.size()), largest(at.p_D.size());
  const auto time = [](Distribution& out, auto&& work) {
    const StageTimer timer;
    work();
    out.add(1e3 * timer.seconds());
  };
  for (const LoopDrives& drives : loops) {
    DirectProduct<float> product(packed, at, drives);
    DirectProduct<double> reference(packed, at, drives);
    std::vector<float> ours;
    LoopPressure loop(0, 0);
    for (int repeat = 0; repeat < 5; ++repeat) {
      time(mean, [&] { ours = mean_radiation_pressure(packed, Medium(), drives, at, pool); });
      time(direct, [&] { product.mean(unit, expected); });
      time(envelope, [&] {
        loop = loop_pressure(packed, Medium(), LoopBasis(packed, drives, pool), at, 0, pool);
      });
      time(direct_envelope, [&] { product.envelope(unit, largest); });
    }
    reference.mean(unit, expected);
    reference.envelope(unit, largest);
    mean_error.add(difference(ours, expected));
    envelope_error.add(difference(loop.envelope, largest));
    rank.add(static_cast<double>(covariance_factor(drives, pool, 1e-6).cols()));
  }
  const std::string with = ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  rows.push_back(
      {"mean over the loop" + with, "ms", mean.summary(), "cgemm, G given", direct.summary().p50});
  rows.push_back({"envelope and mean" + with, "ms", envelope.summary(), "cgemm, G given",
                  direct_envelope.summary().p50});
  if (threads > 1) return;
  rows.push_back({"mean: difference from zgemm", "1", mean_error.summary(), "", 0.0});
  rows.push_back({"envelope: difference from zgemm", "1", envelope_error.summary(), "", 0.0});
  rows.push_back({"rank of the drives' covariance", "1", rank.summary(), "", 0.0});
}
#endif

std::vector<Row> measure_field() {
  std::vector<Row> rows;
  for (const int points : {4, 32, 4096}) add_propagation_rows(points, 15, rows);
#ifdef PROSTM_WITH_OPENBLAS
  std::vector<LoopDrives> loops;
  for (const fields::Pattern pattern : fields::kPatterns) loops.push_back(gallery_drives(pattern));
  for (const int threads : {1, 2}) add_loop_rows(loops, threads, rows);
#else
  fmt::print("no comparison of a loop's field: this build did not find libopenblas-dev\n");
#endif
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure_field);
}
