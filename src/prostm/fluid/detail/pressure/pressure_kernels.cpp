#include "prostm/fluid/detail/pressure/pressure_kernels.hpp"

namespace prostm::fluid {
namespace {

/// D and D⁻¹ of a row: from tables, or in the span from the level's own fields.
struct RowDiagonal {
  RowDiagonal(const PressureLevel& level, int j, int k)
      : span(level.span(j, k)),
        own(level.grid.index(0, j, k)),
        table_diagonal(level.table_diagonal(j, k)),
        table_inverse(level.table_inverse(j, k)),
        level_(level) {}
  bool cut(int i) const { return i >= span.begin && i < span.end; }
  float diagonal(int i) const { return cut(i) ? level_.diagonal[own + i] : table_diagonal[i]; }
  float inverse(int i) const { return cut(i) ? level_.inverse[own + i] : table_inverse[i]; }

  RowSpan span;
  Index own;
  const float *table_diagonal, *table_inverse;

 private:
  const PressureLevel& level_;
};

/// Σ a_f p_f of the cell at index c.
float neighbour_sum(const PressureLevel& level, const float* p, Index c, bool cut) {
  const Index row = level.grid.row(), plane = level.grid.plane();
  if (!cut)
    return ((p[c - 1] + p[c + 1]) + (p[c - row] + p[c + row])) + (p[c - plane] + p[c + plane]);
  const Field* a = level.open;
  return ((a[0][c] * p[c - 1] + a[0][c + 1] * p[c + 1]) +
          (a[1][c] * p[c - row] + a[1][c + row] * p[c + row])) +
         (a[2][c] * p[c - plane] + a[2][c + plane] * p[c + plane]);
}

void smooth(const PressureLevel& level, const float* p, const float* b, float omega, float* out,
            int k0, int k1) {
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowDiagonal d(level, j, k);
      for (int i = 0; i < level.grid.n; ++i) {
        const Index c = d.own + i;
        const float jacobi = d.inverse(i) * (b[c] + neighbour_sum(level, p, c, d.cut(i)));
        out[c] = p[c] + omega * (jacobi - p[c]);
      }
    }
  }
}

void smooth_zero(const PressureLevel& level, const float* b, float omega, float* out, int k0,
                 int k1) {
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowDiagonal d(level, j, k);
      for (int i = 0; i < level.grid.n; ++i) out[d.own + i] = omega * (d.inverse(i) * b[d.own + i]);
    }
  }
}

void apply(const PressureLevel& level, const float* p, float* out, int k0, int k1) {
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < level.grid.n; ++j) {
      const RowDiagonal d(level, j, k);
      for (int i = 0; i < level.grid.n; ++i) {
        const Index c = d.own + i;
        const float image = d.diagonal(i) * p[c] - neighbour_sum(level, p, c, d.cut(i));
        out[c] = d.inverse(i) > 0.0F ? image : 0.0F;
      }
    }
  }
}

float residual(const PressureLevel& level, const float* p, const float* b, int i, int j, int k) {
  const RowDiagonal d(level, j, k);
  const Index c = d.own + i;
  return (b[c] + neighbour_sum(level, p, c, d.cut(i))) - d.diagonal(i) * p[c];
}

void restrict_residual(const PressureLevel& fine, const float* p, const float* b,
                       const PressureLevel& coarse, float* coarse_b, int k0, int k1) {
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < coarse.grid.n; ++j) {
      for (int i = 0; i < coarse.grid.n; ++i) {
        float sum = 0.0F;
        for (int child = 0; child < 8; ++child) {
          sum += residual(fine, p, b, 2 * i + child % 2, 2 * j + child / 2 % 2, 2 * k + child / 4);
        }
        coarse_b[coarse.grid.index(i, j, k)] = 0.5F * sum;
      }
    }
  }
}

void prolong_add(const PressureLevel& coarse, const float* e, const PressureLevel& fine, float* p,
                 int k0, int k1) {
  const Index row = coarse.grid.row(), plane = coarse.grid.plane();
  for (int k = k0; k < k1; ++k) {
    const Index dz = k % 2 == 1 ? plane : k == 0 ? 0 : -plane;
    for (int j = 0; j < fine.grid.n; ++j) {
      const Index dy = j % 2 == 1 ? row : -row;
      const RowDiagonal d(fine, j, k);
      const auto blend = [&](Index c) {
        return 0.5625F * e[c] + 0.1875F * (e[c + dy] + e[c + dz]) + 0.0625F * e[c + dy + dz];
      };
      for (int i = 0; i < fine.grid.n; ++i) {
        const Index c = coarse.grid.index(i / 2, j / 2, k / 2);
        const float value = 0.75F * blend(c) + 0.25F * blend(c + (i % 2 == 1 ? 1 : -1));
        p[d.own + i] += d.inverse(i) > 0.0F ? value : 0.0F;
      }
    }
  }
}

}  // namespace

const PressureKernels& scalar_pressure_kernels() {
  static constexpr PressureKernels kernels{smooth, smooth_zero, apply, restrict_residual,
                                           prolong_add};
  return kernels;
}

}  // namespace prostm::fluid
