/// Path refinement of the textbook planner: the costs of Eqs. (2)–(5) and steepest descent with
/// backtracking. Part of kernel.cpp, which compiles it once per instruction set.

// clang-format off
#if defined(PROSTM_TEXTBOOK_DESCENT) == defined(HWY_TARGET_TOGGLE)
#ifdef PROSTM_TEXTBOOK_DESCENT
#undef PROSTM_TEXTBOOK_DESCENT
#else
#define PROSTM_TEXTBOOK_DESCENT
#endif
// clang-format on

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/target/pressure_share.hpp"
#include "prostm/textbook/kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace prostm::textbook {
namespace HWY_NAMESPACE {
namespace {

void weights(double t, double* w) {
  w[0] = ((-0.5 * t + 1.0) * t - 0.5) * t;
  w[1] = (1.5 * t - 2.5) * t * t + 1.0;
  w[2] = ((-1.5 * t + 2.0) * t + 0.5) * t;
  w[3] = (0.5 * t - 0.5) * t * t;
}

void slopes(double t, double* w) {
  w[0] = (-1.5 * t + 2.0) * t - 0.5;
  w[1] = (4.5 * t - 5.0) * t;
  w[2] = (-4.5 * t + 4.0) * t + 0.5;
  w[3] = (1.5 * t - 1.0) * t;
}

double row(const double* w, const double* p) {
  return w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + w[3] * p[3];
}

/// p*/max p* of the skin, interpolated by Catmull-Rom bicubics; zero elsewhere. Stored with a
/// border of zeros.
class Bicubic {
 public:
  Bicubic(const Field& field, double maximum);
  double value(double x, double y) const;
  /// Returns the value, and writes its gradient [1/mm] to gx, gy.
  double value(double x, double y, double& gx, double& gy) const;

 private:
  static constexpr int kBorder = 3;
  const double* corner(double u, double v, double& s, double& t) const;

  int rows_, cols_, stride_;
  double cell_;
  std::vector<double> value_;
};

/// Steepest descent on the weighted sum of the four costs; x, y hold the samples of all paths, one
/// path after the other.
class Descent {
 public:
  Descent(const Bicubic& raster, const Settings& settings) : raster_(raster), s_(settings) {}
  void run(std::vector<double>& x, std::vector<double>& y, Result& result);

 private:
  using Coordinates = std::vector<double>;
  double cost(const Coordinates& x, const Coordinates& y) const;
  void gradient(const Coordinates& x, const Coordinates& y, Coordinates& gx, Coordinates& gy) const;

  const Bicubic& raster_;
  Settings s_;
};

Bicubic::Bicubic(const Field& field, double maximum)
    : rows_(field.rows), cols_(field.cols), stride_(field.cols + 2 * kBorder), cell_(field.cell) {
  value_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_ + 2 * kBorder),
                0.0);
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < cols_; ++i) {
      const auto from = static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) +
                        static_cast<std::size_t>(i);
      const auto to = static_cast<std::size_t>(j + kBorder) * static_cast<std::size_t>(stride_) +
                      static_cast<std::size_t>(i + kBorder);
      if (field.skin[from] != 0) value_[to] = pressure_share(field.pressure[from], maximum);
    }
  }
}

/// Returns the first of the 4×4 neighbours of (u, v) in cells, or null if all are zero; s, t are
/// the fractions.
const double* Bicubic::corner(double u, double v, double& s, double& t) const {
  if (!(u > -2.0 && u < cols_ + 1.0 && v > -2.0 && v < rows_ + 1.0)) return nullptr;
  const double i = std::floor(u), j = std::floor(v);
  s = u - i;
  t = v - j;
  return value_.data() + (static_cast<std::ptrdiff_t>(j) - 1 + kBorder) * stride_ +
         static_cast<std::ptrdiff_t>(i) - 1 + kBorder;
}

double Bicubic::value(double x, double y) const {
  double s = 0, t = 0, a[4], b[4];
  const double* p = corner(x / cell_, y / cell_, s, t);
  if (p == nullptr) return 0.0;
  weights(s, a);
  weights(t, b);
  return b[0] * row(a, p) + b[1] * row(a, p + stride_) + b[2] * row(a, p + 2 * stride_) +
         b[3] * row(a, p + 3 * stride_);
}

double Bicubic::value(double x, double y, double& gx, double& gy) const {
  double s = 0, t = 0, a[4], b[4], da[4], db[4];
  gx = gy = 0.0;
  const double* p = corner(x / cell_, y / cell_, s, t);
  if (p == nullptr) return 0.0;
  weights(s, a);
  weights(t, b);
  slopes(s, da);
  slopes(t, db);
  double value = 0.0;
  for (int m = 0; m < 4; ++m, p += stride_) {
    const double along = row(a, p);
    value += b[m] * along;
    gx += b[m] * row(da, p) / cell_;
    gy += db[m] * along / cell_;
  }
  return value;
}

double Descent::cost(const Coordinates& x, const Coordinates& y) const {
  const std::size_t n = static_cast<std::size_t>(s_.samples), count = x.size();
  const double segment = s_.max_length / s_.samples;
  double pressure = 0, length = 0, overlap = 0, bend = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i / n * n, next = begin + (i - begin + 1) % n,
                      before = begin + (i - begin + n - 1) % n;
    pressure -= raster_.value(x[i], y[i]);
    const double bx = x[next] - x[i], by = y[next] - y[i], ax = x[i] - x[before],
                 ay = y[i] - y[before];
    const double d = std::sqrt(bx * bx + by * by) - segment;
    length += d * d;
    const double angle = std::atan2(bx * ay - by * ax, ax * bx + ay * by);
    bend += angle * angle;
    for (std::size_t j = i + 1; j < count; ++j) {
      const double dx = x[j] - x[i], dy = y[j] - y[i], d2 = dx * dx + dy * dy;
      if (d2 >= s_.sigma * s_.sigma || j == next || j == before) continue;
      const double depth = s_.sigma - std::sqrt(d2);
      overlap += depth * depth;
    }
  }
  return s_.pressure * pressure + s_.length * length + s_.intersection * overlap +
         s_.bending * bend;
}

void Descent::gradient(const Coordinates& x, const Coordinates& y, Coordinates& gx,
                       Coordinates& gy) const {
  const std::size_t n = static_cast<std::size_t>(s_.samples), count = x.size();
  const double segment = s_.max_length / s_.samples;
  std::fill(gx.begin(), gx.end(), 0.0);
  std::fill(gy.begin(), gy.end(), 0.0);
  const auto pull = [&](std::size_t i, std::size_t j, double force, double dx, double dy) HWY_ATTR {
    gx[j] += force * dx;
    gy[j] += force * dy;
    gx[i] -= force * dx;
    gy[i] -= force * dy;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i / n * n, next = begin + (i - begin + 1) % n,
                      before = begin + (i - begin + n - 1) % n;
    double px = 0, py = 0;
    raster_.value(x[i], y[i], px, py);
    gx[i] -= s_.pressure * px;
    gy[i] -= s_.pressure * py;

    // length and bending; the direction of (a_x, a_y) turns by (−a_y, a_x)/|a|²
    const double bx = x[next] - x[i], by = y[next] - y[i], ax = x[i] - x[before],
                 ay = y[i] - y[before];
    const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, d = std::sqrt(bb);
    if (d > 1e-9) pull(i, next, 2.0 * s_.length * (d - segment) / d, bx, by);
    if (aa > 1e-18 && bb > 1e-18) {
      const double angle = std::atan2(bx * ay - by * ax, ax * bx + ay * by);
      pull(before, i, 2.0 * s_.bending * angle / aa, -ay, ax);
      pull(i, next, -2.0 * s_.bending * angle / bb, -by, bx);
    }
    for (std::size_t j = i + 1; j < count; ++j) {
      const double dx = x[j] - x[i], dy = y[j] - y[i], d2 = dx * dx + dy * dy;
      if (d2 >= s_.sigma * s_.sigma || d2 < 1e-18 || j == next || j == before) continue;
      const double near = std::sqrt(d2);
      pull(i, j, -2.0 * s_.intersection * (s_.sigma - near) / near, dx, dy);
    }
  }
}

void Descent::run(std::vector<double>& x, std::vector<double>& y, Result& result) {
  const std::size_t count = x.size();
  Coordinates gx(count), gy(count), trial_x(count), trial_y(count);
  double present = cost(x, y), step = 0.05;
  result.cost_evaluations = 1;
  while (result.refine_iterations < s_.refine_iterations) {
    gradient(x, y, gx, gy);
    double slope = 0.0;
    for (std::size_t i = 0; i < count; ++i) slope += gx[i] * gx[i] + gy[i] * gy[i];

    // Armijo: the step is doubled, then halved until the cost falls enough
    double trial = 0.0;
    for (step *= 2.0; step > 1e-10; step *= 0.5) {
      for (std::size_t i = 0; i < count; ++i) {
        trial_x[i] = x[i] - step * gx[i];
        trial_y[i] = y[i] - step * gy[i];
      }
      trial = cost(trial_x, trial_y);
      ++result.cost_evaluations;
      if (trial <= present - 1e-4 * step * slope) break;
    }
    if (step <= 1e-10) break;
    ++result.refine_iterations;
    x.swap(trial_x);
    y.swap(trial_y);
    const double decrease = present - trial;
    present = trial;
    if (decrease <= 1e-7 * (1.0 + std::abs(present))) break;
  }
  result.cost = present;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::textbook
HWY_AFTER_NAMESPACE();
#endif
