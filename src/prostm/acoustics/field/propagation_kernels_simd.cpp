#include <cmath>
#include <numbers>

#include "prostm/acoustics/field/propagation_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/acoustics/field/propagation_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

// The lanes of a vector are transducers, so that few points take no longer per point than many. At
// 0.5 m the phase is 400 rad, which single precision resolves only to 2e-5 rad. So r² is in double
// precision, from |p|² − 2 p·t + |t|², and with r₀ its root in single precision
//   kr/π = r₀ k/π + (r² − r₀²) (k/π)/(2 r₀),
// where the first term is reduced modulo half turns in double precision and the
// second is small.
HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
void Rows(const PackedArray& packed, std::span<const Vec3> points, std::span<const Vec3> normals,
          float* re, float* im) {
  propagation_rows_plain(packed, points, normals, re, im);
}

void RowInSingle(const PackedArray& packed, const Vec3& point, float* re, float* im) {
  propagation_rows_plain(packed, {&point, 1}, {}, re, im);
}
#else
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, PackedArray::kRowBlock>;
using V = hn::Vec<D>;
using DI = hn::RebindToSigned<D>;
using DD = hn::Repartition<double, D>;
using VD = hn::Vec<DD>;

/// A vector of floats as two of doubles.
struct Pair {
  VD low, high;
};

HWY_INLINE V set(float value) {
  return hn::Set(D(), value);
}

HWY_INLINE V narrow(const Pair& wide) {
  const hn::Half<D> half;
  return hn::Combine(D(), hn::DemoteTo(half, wide.high), hn::DemoteTo(half, wide.low));
}

HWY_INLINE Pair widen(V v) {
  const DD dd;
  return {hn::PromoteTo(dd, hn::LowerHalf(v)), hn::PromoteTo(dd, hn::UpperHalf(hn::Half<D>(), v))};
}

/// sin πg and cos πg for |g| ≤ 1/2, within 2e-8: Chebyshev interpolation in g².
HWY_INLINE void sin_cos_pi(V g, V& sine, V& cosine) {
  const V u = hn::Mul(g, g);
  V s = set(0.07765766031F);
  s = hn::MulAdd(s, u, set(-0.5982912856F));
  s = hn::MulAdd(s, u, set(2.550077523F));
  s = hn::MulAdd(s, u, set(-5.167710084F));
  s = hn::MulAdd(s, u, set(3.14159264F));
  sine = hn::Mul(s, g);
  V c = set(-0.02439632437F);
  c = hn::MulAdd(c, u, set(0.2349373138F));
  c = hn::MulAdd(c, u, set(-1.335212003F));
  c = hn::MulAdd(c, u, set(4.05870916F));
  c = hn::MulAdd(c, u, set(-4.934802137F));
  cosine = hn::MulAdd(c, u, set(1.0F));
}

/// Splits kr/π into whole + rest, `whole` being an integer.
HWY_INLINE void half_turns(const Pair& square, V r, V per_r, double per_metre, V& whole, V& rest) {
  const DD dd;
  const Pair root = widen(r);
  const VD scale = hn::Set(dd, per_metre);
  const Pair turns{hn::Round(hn::Mul(root.low, scale)), hn::Round(hn::Mul(root.high, scale))};
  const Pair left{hn::MulSub(root.low, scale, turns.low), hn::MulSub(root.high, scale, turns.high)};
  const Pair error{hn::NegMulAdd(root.low, root.low, square.low),
                   hn::NegMulAdd(root.high, root.high, square.high)};
  whole = narrow(turns);
  const V correction =
      hn::Mul(narrow(error), hn::Mul(per_r, set(0.5F * static_cast<float>(per_metre))));
  rest = hn::Add(narrow(left), correction);
}

struct Direction {
  V x, y, z;
};

HWY_INLINE V dot(const Direction& a, const Direction& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

/// D(θ) from the polynomial, given cos θ.
HWY_INLINE V polynomial_beam(const PackedArray& packed, V cosine) {
  const V v = hn::MulSub(hn::Add(cosine, cosine), cosine, set(1.0F));
  V value = set(packed.polynomial[PackedArray::kBeamTerms - 1]);
  for (int k = PackedArray::kBeamTerms - 2; k >= 0; --k) {
    value = hn::MulAdd(value, v, set(packed.polynomial[k]));
  }
  return hn::IfThenZeroElse(hn::Lt(cosine, hn::Zero(D())), value);
}

/// D(θ) from the table. `chord`, the squared distance between the unit vectors along the direction
/// and along the normal, is 4 sin²(θ/2), which is accurate also for small θ.
HWY_INLINE V table_beam(const PackedArray& packed, V chord) {
  const D d;
  const DI di;
  constexpr int kSteps = PackedArray::kDirectivitySteps;
  // sin(θ/2) / sin 45° = √(chord / 2)
  const V place = hn::Mul(hn::Sqrt(hn::Mul(chord, set(0.5F))), set(static_cast<float>(kSteps)));
  const auto step = hn::Min(hn::ConvertTo(di, place), hn::Set(di, kSteps));
  const V part = hn::Sub(place, hn::ConvertTo(d, step));
  const V value = hn::MulAdd(part, hn::GatherIndex(d, packed.rise.data(), step),
                             hn::GatherIndex(d, packed.directivity.data(), step));
  return hn::IfThenElseZero(hn::Le(chord, set(2.0F)), value);
}

/// D(θ) in the directions of the transducers from n on.
HWY_INLINE V directivity_of(const PackedArray& packed, const Direction& way, std::size_t n) {
  const D d;
  const Direction normal{hn::LoadU(d, packed.normal_x.data() + n),
                         hn::LoadU(d, packed.normal_y.data() + n),
                         hn::LoadU(d, packed.normal_z.data() + n)};
  if (packed.beam == PackedArray::Beam::Polynomial) {
    return polynomial_beam(packed, dot(way, normal));
  }
  const Direction apart{hn::Sub(way.x, normal.x), hn::Sub(way.y, normal.y),
                        hn::Sub(way.z, normal.z)};
  return table_beam(packed, dot(apart, apart));
}

/// e^{−αr} = e^{−αr_c} e^{−α(r − r_c)}, where r_c is the distance from the array's centre. For most
/// arrays α(r − r_c) is so small that four terms of the series are exact to rounding.
struct Absorption {
  float per_metre, middle, at_middle;  // −α, r_c, e^{−αr_c}
  bool series;
};

HWY_INLINE V absorbed(const Absorption& air, V r) {
  if (!air.series) return hn::Exp(D(), hn::Mul(set(air.per_metre), r));
  const V x = hn::Mul(set(air.per_metre), hn::Sub(r, set(air.middle)));
  V sum = hn::MulAdd(x, set(1.0F / 6.0F), set(0.5F));
  sum = hn::MulAdd(sum, x, set(1.0F));
  sum = hn::MulAdd(sum, x, set(1.0F));
  return hn::Mul(sum, set(air.at_middle));
}

Absorption absorption_around(const PackedArray& packed, const Vec3& p) {
  constexpr double kSmall = 0.04;  // x⁴/24 = 1e-7
  const double middle = (p - packed.centre).norm(), alpha = packed.wave.absorption;
  return {static_cast<float>(-alpha), static_cast<float>(middle),
          static_cast<float>(std::exp(-alpha * middle)), alpha * packed.reach < kSmall};
}

/// One point, as constants of the computation in all lanes.
struct Point {
  double x2, y2, z2, square;  // −2x, −2y, −2z, |p|²
  float x, y, z;
  float nx, ny, nz;  // the surface's normal, reversed to point into it
  Absorption absorption;
};

/// r² for the transducers from n on.
HWY_INLINE VD square_distance(const PackedArray& packed, const Point& p, std::size_t n) {
  const DD dd;
  VD sum = hn::Add(hn::LoadU(dd, packed.square.data() + n), hn::Set(dd, p.square));
  sum = hn::MulAdd(hn::LoadU(dd, packed.x.data() + n), hn::Set(dd, p.x2), sum);
  sum = hn::MulAdd(hn::LoadU(dd, packed.y.data() + n), hn::Set(dd, p.y2), sum);
  return hn::MulAdd(hn::LoadU(dd, packed.z.data() + n), hn::Set(dd, p.z2), sum);
}

/// Distances and directions from transducers to a point.
struct Way {
  V r, per_r;
  Direction direction;
  V whole, rest;  // kr/π, split as by half_turns
};

HWY_INLINE Way way_from(const PackedArray& packed, const Point& p, double per_metre,
                        std::size_t n) {
  const D d;
  const Pair square{square_distance(packed, p, n), square_distance(packed, p, n + hn::Lanes(DD()))};
  Way way;
  way.r = hn::Sqrt(narrow(square));
  way.per_r = hn::Div(set(1.0F), way.r);
  way.direction = {hn::Mul(hn::Sub(set(p.x), hn::LoadU(d, packed.near_x.data() + n)), way.per_r),
                   hn::Mul(hn::Sub(set(p.y), hn::LoadU(d, packed.near_y.data() + n)), way.per_r),
                   hn::Mul(hn::Sub(set(p.z), hn::LoadU(d, packed.near_z.data() + n)), way.per_r)};
  half_turns(square, way.r, way.per_r, per_metre, way.whole, way.rest);
  return way;
}

/// Same, in single precision throughout.
HWY_INLINE Way way_from_single(const PackedArray& packed, const Point& p, double per_metre,
                               std::size_t n) {
  const D d;
  const Direction apart{hn::Sub(set(p.x), hn::LoadU(d, packed.near_x.data() + n)),
                        hn::Sub(set(p.y), hn::LoadU(d, packed.near_y.data() + n)),
                        hn::Sub(set(p.z), hn::LoadU(d, packed.near_z.data() + n))};
  Way way;
  way.r = hn::Sqrt(dot(apart, apart));
  way.per_r = hn::Div(set(1.0F), way.r);
  way.direction = {hn::Mul(apart.x, way.per_r), hn::Mul(apart.y, way.per_r),
                   hn::Mul(apart.z, way.per_r)};
  const V scale = set(static_cast<float>(per_metre));
  way.whole = hn::Round(hn::Mul(way.r, scale));
  way.rest = hn::MulSub(way.r, scale, way.whole);
  return way;
}

enum class Of { Air, Surface, AirInSingle };

template <Of kOf>
HWY_INLINE void row(const PackedArray& packed, const Point& p, float* HWY_RESTRICT re,
                    float* HWY_RESTRICT im) {
  const D d;
  const double per_metre = packed.wave.number * std::numbers::inv_pi;
  for (std::size_t n = 0; n < packed.stride(); n += hn::Lanes(d)) {
    Way way;
    if constexpr (kOf == Of::AirInSingle) {
      way = way_from_single(packed, p, per_metre, n);
    } else {
      way = way_from(packed, p, per_metre, n);
    }
    V size = hn::Mul(hn::Mul(hn::LoadU(d, packed.gain.data() + n), way.per_r),
                     absorbed(p.absorption, way.r));
    if (packed.beam != PackedArray::Beam::Omni) {
      size = hn::Mul(size, directivity_of(packed, way.direction, n));
    }
    if constexpr (kOf == Of::Surface) {
      const V incidence = dot(way.direction, Direction{set(p.nx), set(p.ny), set(p.nz)});
      size = hn::Mul(size, hn::Max(incidence, hn::Zero(d)));
    }
    V sine, cosine;
    sin_cos_pi(way.rest, sine, cosine);
    // an odd number of half turns changes both signs
    const V sign = hn::BitCast(d, hn::ShiftLeft<31>(hn::ConvertTo(DI(), way.whole)));
    size = hn::Xor(size, sign);
    hn::StoreU(hn::Mul(size, cosine), d, re + n);
    hn::StoreU(hn::Mul(size, sine), d, im + n);
  }
}

HWY_INLINE Point point_at(const PackedArray& packed, const Vec3& p, const Vec3& normal) {
  const Eigen::Vector3f near = p.cast<float>(), into = (-normal).cast<float>();
  return {-2.0 * p.x(),
          -2.0 * p.y(),
          -2.0 * p.z(),
          p.squaredNorm(),
          near.x(),
          near.y(),
          near.z(),
          into.x(),
          into.y(),
          into.z(),
          absorption_around(packed, p)};
}

void RowInSingle(const PackedArray& packed, const Vec3& point, float* re, float* im) {
  row<Of::AirInSingle>(packed, point_at(packed, point, Vec3::Zero()), re, im);
}

void Rows(const PackedArray& packed, std::span<const Vec3> points, std::span<const Vec3> normals,
          float* re, float* im) {
  for (std::size_t m = 0; m < points.size(); ++m) {
    float* re_row = re + m * packed.stride();
    float* im_row = im + m * packed.stride();
    if (normals.empty()) {
      row<Of::Air>(packed, point_at(packed, points[m], Vec3::Zero()), re_row, im_row);
    } else {
      row<Of::Surface>(packed, point_at(packed, points[m], normals[m]), re_row, im_row);
    }
  }
}
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
namespace {
HWY_EXPORT(Rows);
HWY_EXPORT(RowInSingle);
}  // namespace

void propagation_rows(const PackedArray& packed, std::span<const Vec3> points,
                      std::span<const Vec3> normals, float* re, float* im) {
  HWY_DYNAMIC_DISPATCH(Rows)(packed, points, normals, re, im);
}

void propagation_row_in_single(const PackedArray& packed, const Vec3& point, float* re, float* im) {
  HWY_DYNAMIC_DISPATCH(RowInSingle)(packed, point, re, im);
}

}  // namespace prostm
#endif  // HWY_ONCE
