#include "prostm/acoustics/array/array.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

/// Adds a transducer facing +z at (col, row) of a grid that is centred on the origin, in z = 0.
void add_grid_point(TransducerArray& array, double pitch, int cols, int rows, int col, int row) {
  array.position.emplace_back(pitch * (col - 0.5 * (cols - 1)), pitch * (row - 0.5 * (rows - 1)),
                              0.0);
  array.normal.push_back(Vec3::UnitZ());
}

void validate_kind(const TransducerArray& array) {
  require_between("frequency", array.frequency, 20e3, 100e3, "Hz");
  require_between("radius", array.radius, 0.1e-3, 50e-3, "m");
  constexpr double kLeast = 1e-6, kMost = 1e3;
  require_between("amplitude", array.amplitude, kLeast, kMost, "Pa·m");
  require_between("amplitude_low", array.amplitude_low, kLeast, array.amplitude, "Pa·m");
  require_between("amplitude_high", array.amplitude_high, array.amplitude, kMost, "Pa·m");
  if (array.measured_amplitude == 0.0) return;
  require_between("measured_amplitude", array.measured_amplitude, kLeast, kMost, "Pa·m");
}

/// Throws if two transducers are too near. Sorted by x, only neighbours need to be compared.
void refuse_duplicates(const std::vector<Vec3>& position) {
  std::vector<std::size_t> order(position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return position[a].x() != position[b].x() ? position[a].x() < position[b].x() : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3& p = position[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Vec3& q = position[order[j]];
      if (q.x() - p.x() >= kMinTransducerDistance) break;
      if ((q - p).norm() >= kMinTransducerDistance) continue;
      const auto [low, high] = std::minmax(order[i], order[j]);
      throw std::invalid_argument("transducers " + std::to_string(low) + " and " +
                                  std::to_string(high) +
                                  " (from 0) are at the same place; they must be at least 0.1 mm "
                                  "apart");
    }
  }
}

void require_same(const char* what, bool same, const TransducerArray& a, const TransducerArray& b) {
  if (same) return;
  throw std::invalid_argument("the arrays \"" + a.name + "\" and \"" + b.name + "\" differ in " +
                              what + "; joined arrays must have the same");
}

}  // namespace

TransducerArray usx_array() {
  constexpr int kSide = 16;
  TransducerArray array;
  array.name = "usx";
  array.amplitude = 3.4;
  array.amplitude_low = 2.5;
  array.amplitude_high = 8.0;
  array.measured_amplitude = 1.09624833;  // 155 dB SPL on the axis at 0.2 m, as [S-8] measured
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) add_grid_point(array, 10.5e-3, kSide, kSide, col, row);
  }
  return array;
}

TransducerArray autd3_array() {
  constexpr int kCols = 18, kRows = 14;
  TransducerArray array;
  array.name = "autd3";
  array.directivity = Directivity::T4010A1;
  array.amplitude = array.amplitude_low = array.amplitude_high = 4.386;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const bool missing = row == 1 && (col == 1 || col == 2 || col == 16);
      if (!missing) add_grid_point(array, 10.16e-3, kCols, kRows, col, row);
    }
  }
  return array;
}

std::span<const ArrayKind> array_kinds() {
  static constexpr std::array<ArrayKind, 2> kKinds = {{
      {"usx", usx_array},
      {"autd3", autd3_array},
  }};
  return kKinds;
}

void validate(const TransducerArray& array) {
  const std::size_t count = array.position.size();
  if (count < 1 || count > static_cast<std::size_t>(kMaxTransducers)) {
    throw std::invalid_argument("an array has " + std::to_string(count) +
                                " transducers; it must have from 1 to " +
                                std::to_string(kMaxTransducers));
  }
  if (array.normal.size() != count) {
    throw std::invalid_argument("an array has " + std::to_string(array.normal.size()) +
                                " normals; it must have one for each of the " +
                                std::to_string(count) + " transducers");
  }
  validate_kind(array);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string which = " of transducer " + std::to_string(i) + " (from 0)";
    for (const double x : array.position[i]) {
      require_between(("coordinate" + which).c_str(), x, -10.0, 10.0, "m");
    }
    for (const double x : array.normal[i]) {
      require_between(("part of the normal" + which).c_str(), x, -1.0 - 1e-9, 1.0 + 1e-9);
    }
    require_between(("length of the normal" + which).c_str(), array.normal[i].norm(), 1.0 - 1e-9,
                    1.0 + 1e-9);
  }
  refuse_duplicates(array.position);
}

TransducerArray place(const TransducerArray& array, const Pose& X_DA) {
  // reject non-finite values first: comparing or subtracting them would trap
  const Eigen::Matrix4d matrix = X_DA.matrix();
  const bool finite =
      std::all_of(matrix.data(), matrix.data() + 16, [](double x) { return std::isfinite(x); });
  const Eigen::Matrix3d R_DA = X_DA.linear();
  if (!finite || !R_DA.isUnitary(1e-9) || R_DA.determinant() < 0.0) {
    throw std::invalid_argument("the pose of the array \"" + array.name +
                                "\" must be finite, a rotation and a translation");
  }
  TransducerArray placed = array;
  for (Vec3& p : placed.position) p = X_DA * p;
  for (Vec3& n : placed.normal) n = (R_DA * n).normalized();
  return placed;
}

TransducerArray join(std::span<const TransducerArray> arrays) {
  if (arrays.empty()) {
    throw std::invalid_argument("no array was given; there must be at least one to join");
  }
  TransducerArray all = arrays.front();
  for (const TransducerArray& next : arrays.subspan(1)) {
    const TransducerArray& first = arrays.front();
    require_same("frequency", next.frequency == first.frequency, first, next);
    require_same("directivity", next.directivity == first.directivity, first, next);
    require_same("radius", next.radius == first.radius, first, next);
    require_same("amplitude",
                 next.amplitude == first.amplitude && next.amplitude_low == first.amplitude_low &&
                     next.amplitude_high == first.amplitude_high &&
                     next.measured_amplitude == first.measured_amplitude,
                 first, next);
    all.name += " + " + next.name;
    all.position.insert(all.position.end(), next.position.begin(), next.position.end());
    all.normal.insert(all.normal.end(), next.normal.begin(), next.normal.end());
  }
  return all;
}

double wave_number(const TransducerArray& array, const Medium& medium) {
  return 2.0 * kPi * array.frequency / medium.speed_of_sound();
}

Wave wave(const TransducerArray& array, const Medium& medium) {
  return {wave_number(array, medium), medium.absorption(array.frequency)};
}

std::complex<double> propagate(const TransducerArray& array, const Wave& wave, std::size_t i,
                               const Vec3& p) {
  const Vec3 d = p - array.position[i];
  const double r = d.norm();
  const double cos_theta = d.dot(array.normal[i]) / r;
  const double gain = directivity(array.directivity, wave.number * array.radius, cos_theta);
  return std::polar(array.amplitude * gain / r * std::exp(-wave.absorption * r), wave.number * r);
}

std::complex<double> propagate(const TransducerArray& array, const Medium& medium, std::size_t i,
                               const Vec3& p) {
  return propagate(array, wave(array, medium), i, p);
}

double focus_pressure(const TransducerArray& array, const Medium& medium, const Vec3& p) {
  const Wave sound = wave(array, medium);
  double sum = 0.0;
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    sum += std::abs(propagate(array, sound, i, p));
  }
  return sum;
}

void focus_phases(const TransducerArray& array, const Medium& medium, const Vec3& focus,
                  std::span<double> out) {
  const double k = wave_number(array, medium);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = -k * (focus - array.position[i]).norm();
}

double radiation_pressure(double acoustic_pressure_rms, const Medium& medium) {
  const double c = medium.speed_of_sound();
  return 2.0 * acoustic_pressure_rms * acoustic_pressure_rms / (medium.density() * c * c);
}

}  // namespace prostm
