#include "prostm/acoustics/focus/detail/solver_kernels.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/acoustics/focus/detail/solver_kernels.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::solving {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, ComplexRows::kBlock>;
using V = hn::Vec<D>;

constexpr float kNothing = 1e-30F;  // squared magnitude up to which a number has no phase

struct C {
  V re, im;
};

HWY_INLINE C load(const ComplexRows& from, std::size_t row, std::size_t at) {
  const D d;
  return {hn::Load(d, from.re(row) + at), hn::Load(d, from.im(row) + at)};
}

HWY_INLINE void store(const C& value, ComplexRows& to, std::size_t row, std::size_t at) {
  const D d;
  hn::Store(value.re, d, to.re(row) + at);
  hn::Store(value.im, d, to.im(row) + at);
}

HWY_INLINE V squared(const C& z) {
  return hn::MulAdd(z.re, z.re, hn::Mul(z.im, z.im));
}

/// sum + conj(a) b
HWY_INLINE C add_conjugate_product(const C& a, const C& b, const C& sum) {
  return {hn::MulAdd(a.im, b.im, hn::MulAdd(a.re, b.re, sum.re)),
          hn::NegMulAdd(a.im, b.re, hn::MulAdd(a.re, b.im, sum.im))};
}

/// sum + a b
HWY_INLINE C add_product(const C& a, const C& b, const C& sum) {
  return {hn::NegMulAdd(a.im, b.im, hn::MulAdd(a.re, b.re, sum.re)),
          hn::MulAdd(a.im, b.re, hn::MulAdd(a.re, b.im, sum.im))};
}

/// factor/|z|; 0 where |z|² ≤ kNothing.
HWY_INLINE V over_magnitude(V factor, const C& z) {
  const D d;
  const V square = squared(z), some = hn::Set(d, kNothing);
  return hn::IfThenElseZero(hn::Gt(square, some), hn::Div(factor, hn::Sqrt(hn::Max(square, some))));
}

HWY_INLINE float total(V v) {
  return hn::GetLane(hn::SumOfLanes(D(), v));
}

Magnitudes OfRow(const ComplexRows& g, std::size_t m) {
  const D d;
  V sum = hn::Zero(d), squares = sum;
  for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
    const V square = squared(load(g, m, n));
    sum = hn::Add(sum, hn::Sqrt(square));
    squares = hn::Add(squares, square);
  }
  return {total(sum), total(squares)};
}

/// (Gᴴ c) at the transducers from n on.
HWY_INLINE C at_transducers(const ComplexRows& g, std::span<const Complex> c, std::size_t n) {
  const D d;
  C sum{hn::Zero(d), hn::Zero(d)};
  for (std::size_t m = 0; m < c.size(); ++m) {
    const C factor{hn::Set(d, c[m].real()), hn::Set(d, c[m].imag())};
    sum = add_conjugate_product(load(g, m, n), factor, sum);
  }
  return sum;
}

float BackPropagate(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive) {
  const D d;
  V largest = hn::Zero(d);
  for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
    const C sum = at_transducers(g, c, n);
    largest = hn::Max(largest, squared(sum));
    store(sum, drive, 0, n);
  }
  return std::sqrt(hn::GetLane(hn::MaxOfLanes(d, largest)));
}

void BackPropagatePhases(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive) {
  const D d;
  for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
    const C sum = at_transducers(g, c, n);
    const V scale = over_magnitude(hn::Set(d, 1.0F), sum);
    store({hn::Mul(sum.re, scale), hn::Mul(sum.im, scale)}, drive, 0, n);
  }
}

/// y = G q for `kRows` focal points from m on: enough independent sums to hide their latency.
template <std::size_t kRows>
HWY_INLINE void sum_rows(const ComplexRows& g, const ComplexRows& drive, std::size_t m,
                         std::span<Complex> y) {
  const D d;
  C sum[kRows];
  for (C& s : sum) s = {hn::Zero(d), hn::Zero(d)};
  for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
    const C q = load(drive, 0, n);
    for (std::size_t i = 0; i < kRows; ++i) sum[i] = add_product(load(g, m + i, n), q, sum[i]);
  }
  for (std::size_t i = 0; i < kRows; ++i) y[m + i] = {total(sum[i].re), total(sum[i].im)};
}

void PropagateDrives(const ComplexRows& g, const ComplexRows& drive, std::span<Complex> y) {
  std::size_t m = 0;
  for (; m + 4 <= y.size(); m += 4) sum_rows<4>(g, drive, m, y);
  for (; m < y.size(); ++m) sum_rows<1>(g, drive, m, y);
}

/// Σ_n G_in conj(G_jn) for kRows focal points from i on by kRows from j on.
template <std::size_t kRows>
HWY_INLINE void correlate_square(const ComplexRows& g, std::size_t i, std::size_t j,
                                 ComplexRows& out) {
  const D d;
  C sum[kRows][kRows];
  for (auto& row : sum) {
    for (C& s : row) s = {hn::Zero(d), hn::Zero(d)};
  }
  for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
    C left[kRows], right[kRows];
    for (std::size_t k = 0; k < kRows; ++k) {
      left[k] = load(g, i + k, n);
      right[k] = load(g, j + k, n);
    }
    for (std::size_t a = 0; a < kRows; ++a) {
      for (std::size_t b = 0; b < kRows; ++b) {
        sum[a][b] = add_conjugate_product(right[b], left[a], sum[a][b]);
      }
    }
  }
  for (std::size_t a = 0; a < kRows; ++a) {
    for (std::size_t b = 0; b < kRows; ++b) {
      const Complex value(total(sum[a][b].re), total(sum[a][b].im));
      out.set(j + b, i + a, value);
      out.set(i + a, j + b, std::conj(value));
    }
  }
}

void Correlate(const ComplexRows& g, std::size_t foci, ComplexRows& out) {
  const D d;
  const std::size_t even = foci / 2 * 2;
  for (std::size_t j = 0; j < even; j += 2) {
    for (std::size_t i = 0; i <= j; i += 2) correlate_square<2>(g, i, j, out);
  }
  if (even < foci) {
    for (std::size_t i = 0; i < foci; ++i) correlate_square<1>(g, i, even, out);
  }
  for (std::size_t j = 0; j < foci; ++j) {
    const V scale = hn::Set(d, 1.0F / out.re(j)[j]);
    for (std::size_t i = 0; i < foci; i += hn::Lanes(d)) {
      const C value = load(out, j, i);
      store({hn::Mul(value.re, scale), hn::Mul(value.im, scale)}, out, j, i);
    }
  }
}

/// y = R x at the focal points of kBlocks vectors from i on: enough independent sums to hide their
/// latency.
template <std::size_t kBlocks>
HWY_INLINE void apply_blocks(const ComplexRows& r, std::size_t foci, const ComplexRows& x,
                             std::size_t i, ComplexRows& y) {
  const D d;
  const V zero = hn::Zero(d);
  const std::size_t lanes = hn::Lanes(d);
  C even[kBlocks], odd[kBlocks];
  for (std::size_t b = 0; b < kBlocks; ++b) even[b] = odd[b] = {zero, zero};
  const auto add = [&](std::size_t j, C* sum) HWY_ATTR {
    const C factor{hn::Set(d, x.re(0)[j]), hn::Set(d, x.im(0)[j])};
    for (std::size_t b = 0; b < kBlocks; ++b) {
      sum[b] = add_product(load(r, j, i + b * lanes), factor, sum[b]);
    }
  };
  std::size_t j = 0;
  for (; j + 2 <= foci; j += 2) {
    add(j, even);
    add(j + 1, odd);
  }
  if (j < foci) add(j, even);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    store({hn::Add(even[b].re, odd[b].re), hn::Add(even[b].im, odd[b].im)}, y, 0, i + b * lanes);
  }
}

/// y = R x, each in row 0.
HWY_INLINE void apply(const ComplexRows& r, std::size_t foci, const ComplexRows& x,
                      ComplexRows& y) {
  const std::size_t lanes = hn::Lanes(D());
  std::size_t i = 0;
  for (; i + lanes < foci; i += 2 * lanes) apply_blocks<2>(r, foci, x, i, y);
  for (; i < foci; i += lanes) apply_blocks<1>(r, foci, x, i, y);
}

void IterateGsPat(const ComplexRows& r, const ComplexRows& a, std::size_t foci, int iterations,
                  ComplexRows& x, ComplexRows& scratch) {
  const D d;
  const auto set_magnitudes = [&](const ComplexRows& from, ComplexRows& to) HWY_ATTR {
    for (std::size_t i = 0; i < foci; i += hn::Lanes(d)) {
      const C z = load(from, 0, i);
      const V scale = over_magnitude(hn::Load(d, a.re(0) + i), z);
      store({hn::Mul(z.re, scale), hn::Mul(z.im, scale)}, to, 0, i);
    }
  };
  for (int k = 0; k < iterations; ++k) {
    apply(r, foci, x, scratch);
    set_magnitudes(scratch, scratch);
    apply(r, foci, scratch, x);
  }
  set_magnitudes(x, x);
}

void PhaseGradients(const ComplexRows& g, std::span<const Complex> u, const ComplexRows& drive,
                    ComplexRows& turns, std::span<float> normal) {
  const D d;
  const std::size_t foci = u.size();
  for (std::size_t m = 0; m < foci; ++m) {
    const V re = hn::Set(d, u[m].real()), im = hn::Set(d, u[m].imag());
    for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
      const C here = load(g, m, n), q = load(drive, 0, n);
      const C y = add_product(here, q, {hn::Zero(d), hn::Zero(d)});
      hn::Store(hn::MulSub(im, y.re, hn::Mul(re, y.im)), d, turns.re(m) + n);
    }
    for (std::size_t other = 0; other <= m; ++other) {
      V sum = hn::Zero(d);
      for (std::size_t n = 0; n < g.stride(); n += hn::Lanes(d)) {
        sum = hn::MulAdd(hn::Load(d, turns.re(m) + n), hn::Load(d, turns.re(other) + n), sum);
      }
      normal[m * foci + other] = normal[other * foci + m] = total(sum);
    }
  }
}

void TurnPhases(const ComplexRows& turns, std::span<const float> x, ComplexRows& drive) {
  const D d;
  for (std::size_t n = 0; n < drive.stride(); n += hn::Lanes(d)) {
    V delta = hn::Zero(d);
    for (std::size_t m = 0; m < x.size(); ++m) {
      delta = hn::MulAdd(hn::Load(d, turns.re(m) + n), hn::Set(d, x[m]), delta);
    }
    const C q = load(drive, 0, n);
    const V one = hn::Set(d, 1.0F);
    const V scale = hn::Div(one, hn::Sqrt(hn::MulAdd(delta, delta, one)));
    store({hn::Mul(scale, hn::NegMulAdd(delta, q.im, q.re)),
           hn::Mul(scale, hn::MulAdd(delta, q.re, q.im))},
          drive, 0, n);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::solving
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::solving {
namespace {

HWY_EXPORT(OfRow);
HWY_EXPORT(BackPropagate);
HWY_EXPORT(BackPropagatePhases);
HWY_EXPORT(PropagateDrives);
HWY_EXPORT(Correlate);
HWY_EXPORT(IterateGsPat);
HWY_EXPORT(PhaseGradients);
HWY_EXPORT(TurnPhases);

}  // namespace

Magnitudes magnitudes(const ComplexRows& g, std::size_t m) {
  return HWY_DYNAMIC_DISPATCH(OfRow)(g, m);
}

float back_propagate(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive) {
  return HWY_DYNAMIC_DISPATCH(BackPropagate)(g, c, drive);
}

void back_propagate_phases(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive) {
  HWY_DYNAMIC_DISPATCH(BackPropagatePhases)(g, c, drive);
}

void propagate_drives(const ComplexRows& g, const ComplexRows& drive, std::span<Complex> y) {
  HWY_DYNAMIC_DISPATCH(PropagateDrives)(g, drive, y);
}

void correlate(const ComplexRows& g, std::size_t foci, ComplexRows& out) {
  HWY_DYNAMIC_DISPATCH(Correlate)(g, foci, out);
}

void iterate_gs_pat(const ComplexRows& r, const ComplexRows& a, std::size_t foci, int iterations,
                    ComplexRows& x, ComplexRows& scratch) {
  HWY_DYNAMIC_DISPATCH(IterateGsPat)(r, a, foci, iterations, x, scratch);
}

void phase_gradients(const ComplexRows& g, std::span<const Complex> u, const ComplexRows& drive,
                     ComplexRows& turns, std::span<float> normal) {
  HWY_DYNAMIC_DISPATCH(PhaseGradients)(g, u, drive, turns, normal);
}

void turn_phases(const ComplexRows& turns, std::span<const float> x, ComplexRows& drive) {
  HWY_DYNAMIC_DISPATCH(TurnPhases)(turns, x, drive);
}

}  // namespace prostm::solving
#endif  // HWY_ONCE
