#include "prostm/device/safety/focus_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/device/safety/safety_settings.hpp"

namespace prostm {
namespace {

constexpr double kNearest = 10e-3;  // a transducer's far field begins there [m]
constexpr double kAbove = 20e-3, kHeight = 0.5, kBeside = 0.12;  // of the grid, from the array [m]
constexpr double kSpacing = 20e-3;                               // [m]
constexpr double kMostWork = 4e7;   // nodes × transducers; larger arrays get a coarser grid
constexpr float kLeast = 1.0F;      // avoids a division by 0 [Pa]
constexpr double kRoundUp = 1.01;   // covers the errors of the directivity's table and of floats
constexpr double kCurvature = 1.5;  // safety factor on the rise found from second differences

/// Directivity over cos θ from 0 to 1. Behind a transducer it keeps its value at 90°, so that there
/// is no step between two nodes of the grid.
class DirectivityTable {
 public:
  explicit DirectivityTable(const TransducerArray& array) {
    // wave number in air at 20 °C; its variation of a few percent hardly changes the directivity
    const double ka = wave_number(array, Medium{}) * array.radius;
    for (std::size_t i = 0; i < kSize; ++i) {
      value_[i] = static_cast<float>(
          directivity(array.directivity, ka, static_cast<double>(i) / (kSize - 1)));
    }
  }
  float at(float cosine) const {
    const float steps = std::clamp(cosine, 0.0F, 1.0F) * static_cast<float>(kSize - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(steps), kSize - 2);
    return value_[i] + (steps - static_cast<float>(i)) * (value_[i + 1] - value_[i]);
  }

 private:
  static constexpr std::size_t kSize = 1025;
  std::array<float, kSize> value_{};
};

/// Σ D(θ)/r e^{−αr} over the transducers. @param absorption α [Np/m].
double spread_at(const TransducerArray& array, const Vec3& p, double absorption) {
  const double ka = wave_number(array, Medium{}) * array.radius;
  double sum = 0.0;
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    const Vec3 d = p - array.position[i];
    const double r = std::max(d.norm(), kNearest);
    sum += directivity(array.directivity, ka, d.dot(array.normal[i]) / r) / r *
           std::exp(-absorption * r);
  }
  return sum;
}

Eigen::AlignedBox3d box_around(const TransducerArray& array) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : array.position) box.extend(p);
  return {box.min() + Vec3(-kBeside, -kBeside, kAbove),
          box.max() + Vec3(kBeside, kBeside, kAbove + kHeight)};
}

}  // namespace

double largest_amplitude(const TransducerArray& array) {
  return std::max(kLargestAmplitude, array.amplitude_high);
}

double smallest_amplitude(const TransducerArray& array) {
  const double smallest = std::min(kSmallestAmplitude, array.amplitude_low);
  return array.measured_amplitude > 0.0 ? std::min(smallest, array.measured_amplitude) : smallest;
}

double likely_amplitude(const TransducerArray& array) {
  return array.measured_amplitude > 0.0 ? array.measured_amplitude : array.amplitude;
}

double full_pressure(const TransducerArray& array, const Vec3& p) {
  return largest_amplitude(array) * spread_at(array, p, 0.0);
}

double absorbed_pressure(const TransducerArray& array, const Vec3& p, double amplitude) {
  return amplitude * spread_at(array, p, wave(array, Medium{}).absorption);
}

FocusLevels::FocusLevels(const TransducerArray& array) {
  validate(array);
  box_ = box_around(array);
  const auto transducers = static_cast<double>(array.position.size());
  const Vec3 edges = box_.sizes();
  const double work = (edges / kSpacing).array().ceil().prod() * transducers;
  spacing_ = kSpacing * std::max(1.0, std::cbrt(work / kMostWork));
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] = static_cast<int>(std::ceil(edges[axis] / spacing_)) + 1;
  corner_ = box_.min().cast<float>();
  most_ = box_.max().cast<float>();
  per_metre_ = static_cast<float>(1.0 / spacing_);

  const DirectivityTable directivity(array);
  std::vector<Eigen::Vector3f> position, normal;
  for (const Vec3& p : array.position) position.push_back(p.cast<float>());
  for (const Vec3& n : array.normal) normal.push_back(n.cast<float>());
  const auto amplitude = static_cast<float>(kRoundUp * largest_amplitude(array));
  node_.resize(static_cast<std::size_t>(size_.prod()));
  for (int z = 0; z < size_[2]; ++z) {
    for (int y = 0; y < size_[1]; ++y) {
      for (int x = 0; x < size_[0]; ++x) {
        const Eigen::Vector3f p = (box_.min() + spacing_ * Vec3(x, y, z)).cast<float>();
        float sum = 0.0F;
        for (std::size_t i = 0; i < position.size(); ++i) {
          const Eigen::Vector3f d = p - position[i];
          const float r = std::max(d.norm(), static_cast<float>(kNearest));
          sum += directivity.at(d.dot(normal[i]) / r) / r;
        }
        node(x, y, z) = std::max(kLeast, amplitude * sum);
      }
    }
  }
  raise();
}

/// Raises the nodes so that interpolation never falls below the exact values. A function with a
/// second difference of −κ over a step lies up to κ/8 above the straight line between two nodes,
/// along each axis; κ comes from the second differences at the nodes and their neighbours.
void FocusLevels::raise() {
  const std::vector<float> truth = node_;
  const auto value = [&](int x, int y, int z) {
    return truth[static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x)];
  };
  const auto bend = [&](Eigen::Vector3i at) {
    float sum = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3i middle = at;
      middle[axis] = std::clamp(at[axis], 1, size_[axis] - 2);
      Eigen::Vector3i before = middle, after = middle;
      --before[axis];
      ++after[axis];
      const float second = value(before[0], before[1], before[2]) -
                           2.0F * value(middle[0], middle[1], middle[2]) +
                           value(after[0], after[1], after[2]);
      sum += std::max(0.0F, -second);
    }
    return sum;
  };
  std::vector<float> bends(truth.size());
  for (int z = 0, i = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x, ++i) bends[static_cast<std::size_t>(i)] = bend({x, y, z});
  for (int z = 0; z < size_[2]; ++z) {
    for (int y = 0; y < size_[1]; ++y) {
      for (int x = 0; x < size_[0]; ++x) {
        float most = 0.0F;
        for (int c = std::max(0, z - 1); c <= std::min(size_[2] - 1, z + 1); ++c)
          for (int b = std::max(0, y - 1); b <= std::min(size_[1] - 1, y + 1); ++b)
            for (int a = std::max(0, x - 1); a <= std::min(size_[0] - 1, x + 1); ++a)
              most = std::max(most,
                              bends[static_cast<std::size_t>((c * size_[1] + b) * size_[0] + a)]);
        node(x, y, z) += static_cast<float>(kCurvature / 8.0) * most;
      }
    }
  }
}

bool FocusLevels::holds(const Eigen::Vector3f& p) const noexcept {
  return (p.array() >= corner_.array()).all() && (p.array() <= most_.array()).all();
}

float FocusLevels::pressure(const Eigen::Vector3f& p) const noexcept {
  const Eigen::Vector3f steps = (p - corner_) * per_metre_;
  const auto cell = [&](int axis) {
    return std::clamp(static_cast<int>(steps[axis]), 0, size_[axis] - 2);
  };
  const int x = cell(0), y = cell(1), z = cell(2);
  const float u = steps.x() - static_cast<float>(x), v = steps.y() - static_cast<float>(y),
              w = steps.z() - static_cast<float>(z);
  const std::size_t row = static_cast<std::size_t>(size_[0]),
                    layer = row * static_cast<std::size_t>(size_[1]);
  const float* at = node_.data() + static_cast<std::size_t>(z) * layer +
                    static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
  const auto line = [u](const float* a) { return a[0] + u * (a[1] - a[0]); };
  const auto sheet = [&](const float* a) {
    const float near = line(a);
    return near + v * (line(a + row) - near);
  };
  const float low = sheet(at);
  return low + w * (sheet(at + layer) - low);
}

}  // namespace prostm
