#include "prostm/acoustics/field/propagation_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

/// Number of transducers with padding: copies of the last transducer with gain 0.
std::size_t padded(std::size_t count) {
  constexpr std::size_t kBlock = PackedArray::kRowBlock;
  return (count + kBlock - 1) / kBlock * kBlock;
}

void tabulate_directivity(PackedArray& packed) {
  const double ka = packed.wave.number * packed.array.radius;
  const auto at = [&](int step) {
    const double t = std::sqrt(0.5) * step / PackedArray::kDirectivitySteps;
    return directivity(packed.array.directivity, ka, std::max(1.0 - 2.0 * t * t, 0.0));
  };
  for (int i = 0; i <= PackedArray::kDirectivitySteps; ++i) {
    const double here = at(i);
    packed.directivity.push_back(static_cast<float>(here));
    packed.rise.push_back(
        static_cast<float>(i < PackedArray::kDirectivitySteps ? at(i + 1) - here : 0.0));
  }
}

/// Converts a sum of Chebyshev polynomials T_0 … of v with these weights to powers of v.
std::array<double, PackedArray::kBeamTerms> in_powers(
    const std::array<double, PackedArray::kBeamTerms>& weight) {
  std::array<double, PackedArray::kBeamTerms> sum{}, before{}, now{};
  now[0] = 1.0;  // T_0; T_1 = v T_0, then T_{k+1} = 2 v T_k − T_{k−1}
  for (std::size_t k = 0; k < sum.size(); ++k) {
    std::array<double, PackedArray::kBeamTerms> next{};
    for (std::size_t i = 0; i <= k; ++i) sum[i] += weight[k] * now[i];
    for (std::size_t i = 0; i + 1 < next.size(); ++i) next[i + 1] = (k == 0 ? 1.0 : 2.0) * now[i];
    for (std::size_t i = 0; i < next.size(); ++i) next[i] -= before[i];
    before = now;
    now = next;
  }
  return sum;
}

/// Fits D by a polynomial in v = 2 cos²θ − 1, interpolated at the Chebyshev points. @return whether
/// it is within 2e-7.
bool fit_directivity(PackedArray& packed) {
  constexpr std::size_t kTerms = PackedArray::kBeamTerms;
  const double ka = packed.wave.number * packed.array.radius;
  const auto at = [&](double v) {
    return directivity(packed.array.directivity, ka, std::sqrt(0.5 * (1.0 + v)));
  };
  std::array<double, kTerms> weight{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double angle = kPi * (static_cast<double>(i) + 0.5) / kTerms;
    for (std::size_t k = 0; k < kTerms; ++k) {
      weight[k] += (k == 0 ? 1.0 : 2.0) / kTerms * at(std::cos(angle)) *
                   std::cos(static_cast<double>(k) * angle);
    }
  }
  const std::array<double, kTerms> power = in_powers(weight);
  for (std::size_t k = 0; k < kTerms; ++k) packed.polynomial[k] = static_cast<float>(power[k]);
  for (int i = 0; i <= 1000; ++i) {
    const double v = -1.0 + 0.002 * i;
    double value = 0.0;
    for (std::size_t k = kTerms; k-- > 0;) value = value * v + power[k];
    if (std::abs(value - at(std::min(v, 1.0))) > 2e-7) return false;
  }
  return true;
}

void prepare_directivity(PackedArray& packed) {
  if (packed.array.directivity == Directivity::Omni) return;
  if (fit_directivity(packed)) {
    packed.beam = PackedArray::Beam::Polynomial;
  } else {
    packed.beam = PackedArray::Beam::Table;
    tabulate_directivity(packed);
  }
}

}  // namespace

PackedArray::PackedArray(const TransducerArray& given, const Medium& medium) : array(given) {
  validate(array);
  wave = prostm::wave(array, medium);
  for (std::size_t n = 0; n < padded(transducers()); ++n) {
    const std::size_t from = std::min(n, transducers() - 1);
    const Vec3 p = array.position[from];
    const Eigen::Vector3f near = p.cast<float>(), normal = array.normal[from].cast<float>();
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
    square.push_back(p.squaredNorm());
    near_x.push_back(near.x());
    near_y.push_back(near.y());
    near_z.push_back(near.z());
    normal_x.push_back(normal.x());
    normal_y.push_back(normal.y());
    normal_z.push_back(normal.z());
    gain.push_back(n < transducers() ? static_cast<float>(array.amplitude) : 0.0F);
  }
  for (const Vec3& p : array.position) centre += p / static_cast<double>(transducers());
  for (const Vec3& p : array.position) reach = std::max(reach, (p - centre).norm());
  prepare_directivity(*this);
}

void propagation_rows_plain(const PackedArray& packed, std::span<const Vec3> points,
                            std::span<const Vec3> normals, float* re, float* im) {
  for (std::size_t m = 0; m < points.size(); ++m) {
    float* re_row = re + m * packed.stride();
    float* im_row = im + m * packed.stride();
    std::fill(re_row, re_row + packed.stride(), 0.0F);
    std::fill(im_row, im_row + packed.stride(), 0.0F);
    for (std::size_t n = 0; n < packed.transducers(); ++n) {
      std::complex<double> g = propagate(packed.array, packed.wave, n, points[m]);
      if (!normals.empty()) {
        const Vec3 way = (points[m] - packed.array.position[n]).normalized();
        g *= std::max(-way.dot(normals[m]), 0.0);
      }
      re_row[n] = static_cast<float>(g.real());
      im_row[n] = static_cast<float>(g.imag());
    }
  }
}

}  // namespace prostm
