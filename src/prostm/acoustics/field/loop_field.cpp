#include "prostm/acoustics/field/loop_field.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>

#include "prostm/acoustics/field/propagation.hpp"

namespace prostm {
namespace {

constexpr double kTolerance = 1e-6;  // share of the drives' power
constexpr std::size_t kBlock = 48;   // points whose rows stay in the cache together

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

PackedMatrix packed_from(const Eigen::MatrixXcf& m, std::size_t rows) {
  PackedMatrix out(rows, static_cast<std::size_t>(m.cols()));
  for (Eigen::Index col = 0; col < m.cols(); ++col) {
    for (Eigen::Index row = 0; row < m.rows(); ++row) {
      out.set(static_cast<std::size_t>(row), static_cast<std::size_t>(col), m(row, col));
    }
  }
  return out;
}

/// Buffers of one thread for a block of points.
struct Scratch {
  Scratch(const PackedArray& packed, std::size_t cols)
      : g_re(kBlock * packed.stride()), g_im(g_re.size()), z_re(kBlock * cols), z_im(z_re.size()) {}
  std::vector<float> g_re, g_im, z_re, z_im;
};

/// Field and pressure at a block's points over the loop.
struct Course {
  explicit Course(std::size_t cols) : re(kBlock * cols), im(re.size()), pressure(cols) {}
  std::vector<float> re, im, pressure;
};

Eigen::Map<const Eigen::ArrayXf> course_of(std::span<const float> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

float mean_of(std::span<const float> x) {
  return static_cast<float>(course_of(x).cast<double>().mean());
}

/// Calls f(first point, number of points, scratch, thread) for all blocks of points. Each thread
/// has its own scratch, which holds the rows of G at the points and their product with `right`.
template <class F>
void for_blocks(const PackedArray& packed, const SurfacePoints& surface, const PackedMatrix& right,
                WorkerPool& pool, F&& f) {
  const std::size_t points = surface.p_D.size(), blocks = (points + kBlock - 1) / kBlock;
  std::vector<Scratch> scratch(static_cast<std::size_t>(pool.threads()),
                               Scratch(packed, right.cols()));
  std::atomic<std::size_t> next{0};
  pool.run(pool.threads(), [&](int thread) {
    Scratch& mine = scratch[static_cast<std::size_t>(thread)];
    for (std::size_t block = next++; block < blocks; block = next++) {
      const std::size_t first = block * kBlock, count = std::min(kBlock, points - first);
      propagation_rows(packed, std::span(surface.p_D).subspan(first, count),
                       std::span(surface.normal).subspan(first, count), mine.g_re.data(),
                       mine.g_im.data());
      complex_product({mine.g_re.data(), mine.g_im.data(), count, packed.stride()}, right, 0,
                      mine.z_re.data(), mine.z_im.data());
      f(first, count, mine, static_cast<std::size_t>(thread));
    }
  });
}

void check(const PackedArray& packed, const LoopDrives& drives) {
  if (static_cast<std::size_t>(drives.rows()) != packed.transducers()) {
    refuse("the loop has drives for " + std::to_string(drives.rows()) +
           " transducers, but the array has " + std::to_string(packed.transducers()));
  }
}

/// Returns v of (A20) for one set of drives; p of (A1) without normals.
Eigen::VectorXcf field_of(const PackedArray& packed, std::span<const Vec3> points,
                          std::span<const Vec3> normals, const Eigen::VectorXcf& drives) {
  const PackedMatrix right = packed_from(drives, packed.stride());
  std::vector<float> re(packed.stride()), im(re.size()), z_re(right.cols()), z_im(z_re.size());
  Eigen::VectorXcf out(static_cast<Eigen::Index>(points.size()));
  for (std::size_t m = 0; m < points.size(); ++m) {
    propagation_rows(packed, points.subspan(m, 1),
                     normals.empty() ? normals : normals.subspan(m, 1), re.data(), im.data());
    complex_product({re.data(), im.data(), 1, packed.stride()}, right, 0, z_re.data(), z_im.data());
    out[static_cast<Eigen::Index>(m)] = {z_re[0], z_im[0]};
  }
  return out;
}

}  // namespace

void validate(const SurfacePoints& surface, const TransducerArray& array) {
  if (surface.p_D.empty()) refuse("a surface has no point; it must have at least one");
  if (surface.normal.size() != surface.p_D.size()) {
    refuse("a surface has " + std::to_string(surface.normal.size()) +
           " normals; it must have one for each of its " + std::to_string(surface.p_D.size()) +
           " points");
  }
  const auto finite = [](const Vec3& v) {
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
  };
  for (std::size_t m = 0; m < surface.p_D.size(); ++m) {
    const std::string which = "point " + std::to_string(m) + " (from 0) of a surface ";
    if (!finite(surface.p_D[m]) || !finite(surface.normal[m])) {
      refuse(which + "must have a finite position and normal");
    }
    if (std::abs(surface.normal[m].squaredNorm() - 1.0) > 2e-6) {
      refuse(which + "must have a normal of length 1");
    }
    for (std::size_t n = 0; n < array.position.size(); ++n) {
      if ((surface.p_D[m] - array.position[n]).squaredNorm() >= kNearestPoint * kNearestPoint) {
        continue;
      }
      refuse(which + "is on transducer " + std::to_string(n) +
             " (from 0); it must be at least 10 mm from every transducer");
    }
  }
}

Eigen::VectorXcf acoustic_pressure(const PackedArray& packed, std::span<const Vec3> points,
                                   const Eigen::VectorXcf& drives) {
  return field_of(packed, points, {}, drives);
}

std::vector<float> radiation_pressure(const PackedArray& packed, const Medium& medium,
                                      const SurfacePoints& surface,
                                      const Eigen::VectorXcf& drives) {
  const Eigen::VectorXcf v = field_of(packed, surface.p_D, surface.normal, drives);
  const float unit = static_cast<float>(radiation_pressure(1.0, medium));
  std::vector<float> out;
  for (const std::complex<float>& value : v) out.push_back(unit * std::norm(value));
  return out;
}

std::vector<float> mean_radiation_pressure(const PackedArray& packed, const Medium& medium,
                                           const LoopDrives& drives, const SurfacePoints& surface,
                                           WorkerPool& pool) {
  validate(surface, packed.array);
  check(packed, drives);
  const PackedMatrix right =
      packed_from(covariance_factor(drives, pool, kTolerance), packed.stride());
  const float unit = static_cast<float>(radiation_pressure(1.0, medium));
  std::vector<float> mean(surface.p_D.size());
  for_blocks(packed, surface, right, pool,
             [&](std::size_t first, std::size_t count, const Scratch& s, std::size_t) {
               for (std::size_t m = 0; m < count; ++m) {
                 const std::size_t at = m * right.cols();
                 mean[first + m] =
                     unit * sum_of_squares(s.z_re.data() + at, s.z_im.data() + at, right.cols());
               }
             });
  return mean;
}

void validate_frames(int frames, std::size_t samples) {
  if (frames == 0 || (frames > 0 && samples % static_cast<std::size_t>(frames) == 0)) return;
  refuse("frames = " + std::to_string(frames) + " must be 0 or a divisor of the loop's " +
         std::to_string(samples) + " samples");
}

LoopPressure::LoopPressure(std::size_t points, int parts)
    : mean(points),
      envelope(points),
      frames(parts),
      frame(points * static_cast<std::size_t>(parts)) {}

void LoopPressure::take(std::size_t point, std::span<const float> pressure) {
  mean[point] = mean_of(pressure);
  envelope[point] = course_of(pressure).maxCoeff();
  const auto parts = static_cast<std::size_t>(frames);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t length = pressure.size() / parts;
    frame[point * parts + part] = mean_of(pressure.subspan(part * length, length));
  }
}

LoopBasis::LoopBasis(const PackedArray& packed, const LoopDrives& drives, WorkerPool& pool)
    : samples(static_cast<std::size_t>(drives.cols())), factor(0, 0), course(0, 0) {
  check(packed, drives);
  const Eigen::MatrixXcf q = orthonormal(covariance_factor(drives, pool, kTolerance));
  factor = packed_from(q, packed.stride());
  course = packed_from(q.adjoint() * drives, factor.cols());
}

LoopPressure loop_pressure(const PackedArray& packed, const Medium& medium, const LoopBasis& basis,
                           const SurfacePoints& surface, int frames, WorkerPool& pool) {
  validate(surface, packed.array);
  const std::size_t samples = basis.samples;
  validate_frames(frames, samples);
  const PackedMatrix &factor = basis.factor, &course = basis.course;
  const float unit = static_cast<float>(radiation_pressure(1.0, medium));
  LoopPressure out(surface.p_D.size(), frames);
  std::vector<Course> courses(static_cast<std::size_t>(pool.threads()), Course(course.cols()));
  for_blocks(packed, surface, factor, pool,
             [&](std::size_t first, std::size_t count, const Scratch& s, std::size_t thread) {
               // combine the basis fields at these points to the field of each sample
               Course& c = courses[thread];
               complex_product({s.z_re.data(), s.z_im.data(), count, factor.cols()}, course, 0,
                               c.re.data(), c.im.data());
               for (std::size_t m = 0; m < count; ++m) {
                 const std::size_t at = m * course.cols();
                 squares(c.re.data() + at, c.im.data() + at, course.cols(), unit,
                         c.pressure.data());
                 out.take(first + m, std::span<const float>(c.pressure).first(samples));
               }
             });
  return out;
}

}  // namespace prostm
