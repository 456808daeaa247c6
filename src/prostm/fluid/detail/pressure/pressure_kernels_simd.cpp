#include "prostm/fluid/detail/pressure/pressure_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/pressure/pressure_kernels_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// every row below is processed in whole vectors up to width(): D⁻¹ = 0 there keeps the halo at 0
Index lanes() {
  return static_cast<Index>(hn::Lanes(D()));
}

/// Σ p_f, every face open.
HWY_INLINE V open_sum(const float* p, Index row, Index plane) {
  const D d;
  const V x = hn::Add(hn::LoadU(d, p - 1), hn::LoadU(d, p + 1));
  const V y = hn::Add(hn::Load(d, p - row), hn::Load(d, p + row));
  const V z = hn::Add(hn::Load(d, p - plane), hn::Load(d, p + plane));
  return hn::Add(hn::Add(x, y), z);
}

/// Σ a_f p_f with the level's fractions, at index c.
HWY_INLINE V cut_sum(const PressureLevel& level, const float* p, Index c) {
  const D d;
  const Index row = level.grid.row(), plane = level.grid.plane();
  const float *x = level.open[0].data() + c, *y = level.open[1].data() + c,
              *z = level.open[2].data() + c;
  V sum = hn::Mul(hn::Load(d, x), hn::LoadU(d, p + c - 1));
  sum = hn::MulAdd(hn::LoadU(d, x + 1), hn::LoadU(d, p + c + 1), sum);
  sum = hn::MulAdd(hn::Load(d, y), hn::Load(d, p + c - row), sum);
  sum = hn::MulAdd(hn::Load(d, y + row), hn::Load(d, p + c + row), sum);
  sum = hn::MulAdd(hn::Load(d, z), hn::Load(d, p + c - plane), sum);
  return hn::MulAdd(hn::Load(d, z + plane), hn::Load(d, p + c + plane), sum);
}

void Smooth(const PressureLevel& level, const float* HWY_RESTRICT p, const float* HWY_RESTRICT b,
            float omega, float* HWY_RESTRICT out, int k0, int k1) {
  const D d;
  const V weight = hn::Set(d, omega);
  const Index row = level.grid.row(), plane = level.grid.plane(), step = lanes(),
              width = level.grid.width();
  const auto relax = [&](V inverse, V sum, Index c) HWY_ATTR {
    const V old = hn::Load(d, p + c);
    const V jacobi = hn::Mul(inverse, hn::Add(hn::Load(d, b + c), sum));
    hn::Store(hn::MulAdd(weight, hn::Sub(jacobi, old), old), d, out + c);
  };
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowSpan span = level.span(j, k);
      const Index own = level.grid.index(0, j, k);
      const float* table = level.table_inverse(j, k);
      for (Index i = 0; i < span.begin; i += step) {
        relax(hn::LoadU(d, table + i), open_sum(p + own + i, row, plane), own + i);
      }
      for (Index i = span.begin; i < span.end; i += step) {
        relax(hn::Load(d, level.inverse.data() + own + i), cut_sum(level, p, own + i), own + i);
      }
      for (Index i = span.end; i < width; i += step) {
        relax(hn::LoadU(d, table + i), open_sum(p + own + i, row, plane), own + i);
      }
    }
  }
}

void SmoothZero(const PressureLevel& level, const float* HWY_RESTRICT b, float omega,
                float* HWY_RESTRICT out, int k0, int k1) {
  const D d;
  const V weight = hn::Set(d, omega);
  const Index step = lanes(), width = level.grid.width();
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowSpan span = level.span(j, k);
      const Index own = level.grid.index(0, j, k);
      const float* table = level.table_inverse(j, k);
      for (Index i = 0; i < width; i += step) {
        const bool cut = i >= span.begin && i < span.end;
        const V inverse = hn::LoadU(d, cut ? level.inverse.data() + own + i : table + i);
        hn::Store(hn::Mul(weight, hn::Mul(inverse, hn::Load(d, b + own + i))), d, out + own + i);
      }
    }
  }
}

void Apply(const PressureLevel& level, const float* HWY_RESTRICT p, float* HWY_RESTRICT out, int k0,
           int k1) {
  const D d;
  const Index row = level.grid.row(), plane = level.grid.plane(), step = lanes(),
              width = level.grid.width();
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowSpan span = level.span(j, k);
      const Index own = level.grid.index(0, j, k);
      const float *diagonals = level.table_diagonal(j, k), *inverses = level.table_inverse(j, k);
      for (Index i = 0; i < width; i += step) {
        const bool cut = i >= span.begin && i < span.end;
        const Index c = own + i;
        const V neighbours = cut ? cut_sum(level, p, c) : open_sum(p + c, row, plane);
        const V diagonal = hn::LoadU(d, cut ? level.diagonal.data() + c : diagonals + i);
        const V inverse = hn::LoadU(d, cut ? level.inverse.data() + c : inverses + i);
        const V image = hn::MulSub(diagonal, hn::Load(d, p + c), neighbours);
        hn::Store(hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(d)), image), d, out + c);
      }
    }
  }
}

/// sum += b − A p along row (j, k); `sum` holds width() values.
HWY_INLINE void add_residual(const PressureLevel& level, const float* HWY_RESTRICT p,
                             const float* HWY_RESTRICT b, int j, int k, bool first,
                             float* HWY_RESTRICT sum) {
  const D d;
  const Index row = level.grid.row(), plane = level.grid.plane(), step = lanes(),
              width = level.grid.width();
  const RowSpan span = level.span(j, k);
  const Index own = level.grid.index(0, j, k);
  const float* table = level.table_diagonal(j, k);
  for (Index i = 0; i < width; i += step) {
    const bool cut = i >= span.begin && i < span.end;
    const Index c = own + i;
    const V neighbours = cut ? cut_sum(level, p, c) : open_sum(p + c, row, plane);
    const V diagonal = hn::LoadU(d, cut ? level.diagonal.data() + c : table + i);
    const V r =
        hn::NegMulAdd(diagonal, hn::Load(d, p + c), hn::Add(hn::Load(d, b + c), neighbours));
    hn::StoreU(first ? r : hn::Add(hn::LoadU(d, sum + i), r), d, sum + i);
  }
}

void RestrictResidual(const PressureLevel& fine, const float* HWY_RESTRICT p,
                      const float* HWY_RESTRICT b, const PressureLevel& coarse,
                      float* HWY_RESTRICT coarse_b, int k0, int k1) {
  alignas(64) float sum[2 * PressureLevel::kMaxCells];
  const Index width = fine.grid.width();
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < coarse.grid.n; ++j) {
      for (int child = 0; child < 4; ++child) {
        add_residual(fine, p, b, 2 * j + child % 2, 2 * k + child / 2, child == 0, sum);
      }
      // pairs along x; beyond the row's width the buffer is not read
      float* to = coarse_b + coarse.grid.index(0, j, k);
      for (Index i = 0; i < std::min<Index>(width / 2, coarse.grid.n); ++i)
        to[i] = 0.5F * (sum[2 * i] + sum[2 * i + 1]);
    }
  }
}

void ProlongAdd(const PressureLevel& coarse, const float* HWY_RESTRICT e, const PressureLevel& fine,
                float* HWY_RESTRICT p, int k0, int k1) {
  const D d;
  constexpr Index kPad = PaddedGrid::kLane;
  alignas(64) float blend[PressureLevel::kMaxCells + 3 * kPad];
  // a fine row's padding reads beyond the coarse row's
  alignas(64) float value[2 * PressureLevel::kMaxCells + 4 * kPad] = {};
  const Index row = coarse.grid.row(), plane = coarse.grid.plane(), step = lanes();
  const Index width = coarse.grid.width();
  for (int k = k0; k < k1; ++k) {
    const Index dz = k % 2 == 1 ? plane : k == 0 ? 0 : -plane;
    for (int j = 0; j < fine.grid.n; ++j) {
      const Index dy = j % 2 == 1 ? row : -row;
      // across y and z, one vector more than the row at both ends for the halos
      const float* from = e + coarse.grid.index(0, j / 2, k / 2);
      for (Index i = -step; i < width + step; i += step) {
        const V sides = hn::Add(hn::LoadU(d, from + i + dy), hn::LoadU(d, from + i + dz));
        V v = hn::Mul(hn::Set(d, 0.5625F), hn::LoadU(d, from + i));
        v = hn::MulAdd(hn::Set(d, 0.1875F), sides, v);
        v = hn::MulAdd(hn::Set(d, 0.0625F), hn::LoadU(d, from + i + dy + dz), v);
        hn::StoreU(v, d, blend + kPad + i);
      }
      // along x
      for (Index i = 0; i < width; i += step) {
        const V own = hn::Mul(hn::Set(d, 0.75F), hn::LoadU(d, blend + kPad + i));
        const V quarter = hn::Set(d, 0.25F);
        hn::StoreInterleaved2(hn::MulAdd(quarter, hn::LoadU(d, blend + kPad + i - 1), own),
                              hn::MulAdd(quarter, hn::LoadU(d, blend + kPad + i + 1), own), d,
                              value + 2 * i);
      }
      // an odd row may be one cell longer than all pairs; that cell's own parent is a 0 of the halo
      value[2 * width] = 0.25F * blend[kPad + width - 1];
      const RowSpan span = fine.span(j, k);
      const Index c = fine.grid.index(0, j, k);
      const float* table = fine.table_inverse(j, k);
      for (Index i = 0; i < fine.grid.width(); i += step) {
        const bool cut = i >= span.begin && i < span.end;
        const V inverse = hn::LoadU(d, cut ? fine.inverse.data() + c + i : table + i);
        const V add = hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(d)), hn::LoadU(d, value + i));
        hn::Store(hn::Add(hn::Load(d, p + c + i), add), d, p + c + i);
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::fluid {
namespace {

HWY_EXPORT(Smooth);
HWY_EXPORT(SmoothZero);
HWY_EXPORT(Apply);
HWY_EXPORT(RestrictResidual);
HWY_EXPORT(ProlongAdd);

void smooth(const PressureLevel& level, const float* p, const float* b, float omega, float* out,
            int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(Smooth)(level, p, b, omega, out, k0, k1);
}
void smooth_zero(const PressureLevel& level, const float* b, float omega, float* out, int k0,
                 int k1) {
  HWY_DYNAMIC_DISPATCH(SmoothZero)(level, b, omega, out, k0, k1);
}
void apply(const PressureLevel& level, const float* p, float* out, int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(Apply)(level, p, out, k0, k1);
}
void restrict_residual(const PressureLevel& fine, const float* p, const float* b,
                       const PressureLevel& coarse, float* coarse_b, int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(RestrictResidual)(fine, p, b, coarse, coarse_b, k0, k1);
}
void prolong_add(const PressureLevel& coarse, const float* e, const PressureLevel& fine, float* p,
                 int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(ProlongAdd)(coarse, e, fine, p, k0, k1);
}

}  // namespace

const PressureKernels& fast_pressure_kernels() {
  static constexpr PressureKernels kernels{smooth, smooth_zero, apply, restrict_residual,
                                           prolong_add};
  const bool vectors = (hwy::SupportedTargets() & ~(HWY_SCALAR | HWY_EMU128)) != 0;
  return vectors ? kernels : scalar_pressure_kernels();
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
