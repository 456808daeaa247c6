#include <bit>
#include <cstdint>

#include "prostm/plan/detail/fit/raster/distances.hpp"
#include "prostm/plan/detail/fit/raster/reconstruction.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/plan/detail/fit/raster/reconstruction_simd.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

// A vector holds the eight cells of a tile (or half of them). The closest segment of each is
// searched among the few segments that can be closest to any cell of the tile. With m a segment's
// midpoint, h half its length, and c and r the tile's centre and radius, some segment is no farther
// from every cell than min |c − m| + r, so a segment with |c − m| − h − r beyond that is never
// closest.
HWY_BEFORE_NAMESPACE();
namespace prostm::planning {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
using DI = hn::RebindToSigned<D>;
using VI = hn::Vec<DI>;

constexpr std::size_t kMaxLanes = 8;
constexpr float kFar = 1e9F;  // midpoint of the segments that fill up the last vector [mm]

/// Four quantities of a segment, adjacent in memory, since the lanes of a vector load different
/// segments.
struct alignas(16) Quartet {
  float value[4];
};

/// The quartets of the segments in a vector's lanes, one vector for each quantity.
struct Quartets {
  V value[4];
};

HWY_INLINE Quartets gather(const Quartet* from, const std::int32_t* indices) {
  const D d;
#if HWY_MAX_BYTES >= 32
  // load the rows of two 4×4 blocks, then transpose them: faster than gathers
  const hn::Half<D> half;
  const auto row = [&](std::size_t lane) HWY_ATTR {
    return hn::Combine(d, hn::Load(half, from[indices[lane + 4]].value),
                       hn::Load(half, from[indices[lane]].value));
  };
  const V row0 = row(0), row1 = row(1), row2 = row(2), row3 = row(3);
  const V low02 = hn::InterleaveLower(d, row0, row2), low13 = hn::InterleaveLower(d, row1, row3);
  const V high02 = hn::InterleaveUpper(d, row0, row2), high13 = hn::InterleaveUpper(d, row1, row3);
  return {{hn::InterleaveLower(d, low02, low13), hn::InterleaveUpper(d, low02, low13),
           hn::InterleaveLower(d, high02, high13), hn::InterleaveUpper(d, high02, high13)}};
#else
  alignas(16) float columns[4][hn::MaxLanes(d)];
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    for (std::size_t q = 0; q < 4; ++q) columns[q][lane] = from[indices[lane]].value[q];
  }
  return {{hn::Load(d, columns[0]), hn::Load(d, columns[1]), hn::Load(d, columns[2]),
           hn::Load(d, columns[3])}};
#endif
}

/// The segments of the paths in use, one array for each quantity.
struct Segments {
  static constexpr std::size_t kCapacity = kMaxLoopNodes + kMaxLanes;
  std::size_t count = 0;
  alignas(64) float mid_x[kCapacity], mid_y[kCapacity], half[kCapacity], distance2[kCapacity];
  alignas(64) float ax[kCapacity], ay[kCapacity], ex[kCapacity], ey[kCapacity], inverse[kCapacity];
  alignas(64) std::int32_t node[kCapacity], candidate[kCapacity];
  Quartet edge[kCapacity];  // copy of ax, ay, ex, ey
};

HWY_INLINE void collect(const Loops& loops, Segments& s) {
  s.count = 0;
  const auto lanes = static_cast<std::size_t>(loops.lanes), n = loops.nodes();
  for (std::size_t first = 0; first < n; first += lanes) {
    const std::size_t second = first + lanes == n ? 0 : first + lanes;
    for (std::size_t k = 0; k < static_cast<std::size_t>(loops.paths); ++k) {
      const std::size_t i = s.count++, a = first + k, b = second + k;
      s.ax[i] = loops.x[a];
      s.ay[i] = loops.y[a];
      s.ex[i] = loops.x[b] - loops.x[a];
      s.ey[i] = loops.y[b] - loops.y[a];
      s.node[i] = static_cast<std::int32_t>(a);
      s.edge[i] = {{s.ax[i], s.ay[i], s.ex[i], s.ey[i]}};
    }
  }
  for (std::size_t i = s.count; i < s.count + kMaxLanes; ++i) {
    s.ax[i] = s.ay[i] = kFar;
    s.ex[i] = s.ey[i] = 0.0F;
  }
  const D d;
  for (std::size_t i = 0; i < s.count; i += hn::Lanes(d)) {
    const V ex = hn::Load(d, s.ex + i), ey = hn::Load(d, s.ey + i);
    const V squared = hn::Max(hn::MulAdd(ex, ex, hn::Mul(ey, ey)), hn::Set(d, 1e-12F));
    hn::Store(hn::Div(hn::Set(d, 1.0F), squared), d, s.inverse + i);
    const V half = hn::Set(d, 0.5F);
    hn::Store(hn::Mul(half, hn::Sqrt(squared)), d, s.half + i);
    hn::Store(hn::MulAdd(half, ex, hn::Load(d, s.ax + i)), d, s.mid_x + i);
    hn::Store(hn::MulAdd(half, ey, hn::Load(d, s.ay + i)), d, s.mid_y + i);
  }
}

/// Writes the segments that can be closest to a cell of the tile. @return their number.
HWY_INLINE std::size_t select(const CellTile& tile, Segments& s) {
  const D d;
  const DI di;
  const hn::Rebind<std::uint8_t, D> bytes;
  const V cx = hn::Set(d, tile.centre_x), cy = hn::Set(d, tile.centre_y);
  V least = hn::Set(d, 4.0F * kFar * kFar);
  for (std::size_t i = 0; i < s.count; i += hn::Lanes(d)) {
    const V dx = hn::Sub(cx, hn::Load(d, s.mid_x + i)), dy = hn::Sub(cy, hn::Load(d, s.mid_y + i));
    const V distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
    hn::Store(distance2, d, s.distance2 + i);
    least = hn::Min(least, distance2);
  }
  const float nearest = hn::GetLane(hn::Sqrt(hn::MinOfLanes(d, least)));
  const V reach = hn::Set(d, nearest + 2.0F * tile.radius + 1e-3F);
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.count; i += hn::Lanes(d)) {
    const V limit = hn::Add(hn::Load(d, s.half + i), reach);
    const auto near = hn::Le(hn::Load(d, s.distance2 + i), hn::Mul(limit, limit));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, near, bits);
    const VI index = hn::PromoteTo(di, hn::Load(bytes, kSetBits[bits[0]].data()));
    hn::StoreU(hn::Add(index, hn::Set(di, static_cast<std::int32_t>(i))), di, s.candidate + count);
    count += static_cast<std::size_t>(std::popcount(bits[0]));
  }
  return count;
}

/// to[0..3] += from[0..3]; both aligned to 16 bytes.
HWY_INLINE void add_four(const float* from, float* to) {
  const hn::CappedTag<float, 4> d;
  for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
    hn::Store(hn::Add(hn::Load(d, to + k), hn::Load(d, from + k)), d, to + k);
  }
}

/// Finds the closest points of one tile; adds its cells to the normal equations.
HWY_INLINE void fit_tile(const CellTile& tile, float sigma, Segments& s,
                         ReconstructionScratch::TileFit& fit, ReconstructionScratch& scratch) {
  const D d;
  const DI di;
  const std::size_t count = select(tile, s), step = hn::Lanes(d);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const V falloff = hn::Set(d, -0.5F / (sigma * sigma));
  alignas(64) float sums[4 * 8], ends[8];
  alignas(64) std::int32_t segment[8];
  for (std::size_t c = 0; c < 8; c += step) {
    const V x = hn::Load(d, tile.x + c), y = hn::Load(d, tile.y + c);
    V best = hn::Set(d, 4.0F * kFar * kFar);
    VI chosen = hn::Zero(di);
    for (std::size_t j = 0; j < count; ++j) {
      const auto i = static_cast<std::size_t>(s.candidate[j]);
      const V ex = hn::Set(d, s.ex[i]), ey = hn::Set(d, s.ey[i]);
      const V rx = hn::Sub(x, hn::Set(d, s.ax[i])), ry = hn::Sub(y, hn::Set(d, s.ay[i]));
      const V dot = hn::Mul(hn::MulAdd(rx, ex, hn::Mul(ry, ey)), hn::Set(d, s.inverse[i]));
      const V t = hn::Min(hn::Max(dot, zero), one);
      const V dx = hn::NegMulAdd(t, ex, rx), dy = hn::NegMulAdd(t, ey, ry);
      const V distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
      const auto closer = hn::RebindMask(di, hn::Lt(distance2, best));
      best = hn::Min(distance2, best);
      chosen = hn::IfThenElse(closer, hn::Set(di, s.candidate[j]), chosen);
    }
    // recompute for the chosen segment: cheaper than keeping all values in the search
    hn::Store(chosen, di, segment + c);
    const Quartets edge = gather(s.edge, segment + c);
    const V ex = edge.value[2], ey = edge.value[3];
    const V rx = hn::Sub(x, edge.value[0]), ry = hn::Sub(y, edge.value[1]);
    const V squared = hn::Max(hn::MulAdd(ex, ex, hn::Mul(ey, ey)), hn::Set(d, 1e-12F));
    const V dot = hn::MulAdd(rx, ex, hn::Mul(ry, ey));
    const V t = hn::Min(hn::Max(hn::Div(dot, squared), zero), one);
    const V exponent = hn::Mul(falloff, best);
    const V least = hn::Set(d, kLeastExponent);
    const V phi = hn::IfThenElseZero(hn::Ge(exponent, least), hn::Exp(d, hn::Max(exponent, least)));
    hn::Store(phi, d, fit.phi + c);
    hn::Store(t, d, fit.along + c);
    hn::Store(hn::NegMulAdd(t, ex, rx), d, fit.dx + c);
    hn::Store(hn::NegMulAdd(t, ey, ry), d, fit.dy + c);

    const V w = hn::Load(d, tile.weight + c), p = hn::Load(d, tile.pressure + c);
    const V v = hn::Mul(phi, t), u = hn::Sub(phi, v);
    const V wu = hn::Mul(w, u), wv = hn::Mul(w, v);
    hn::StoreInterleaved4(hn::Mul(wu, u), hn::Mul(wu, v), hn::Mul(wv, v), hn::Mul(wu, p), d,
                          sums + 4 * c);
    hn::Store(hn::Mul(wv, p), d, ends + c);
  }
  for (std::size_t c = 0; c < 8; ++c) {
    fit.segment[c] = s.node[segment[c]];
    const auto a = static_cast<std::size_t>(fit.segment[c]);
    add_four(sums + 4 * c, scratch.normal.data() + 4 * a);
    scratch.normal_end[a] += ends[c];
  }
}

/// Adds the gradient of one tile's cells to their segments. @param segments by first node: the
/// pressure there, its change along the segment, ex and ey. @return the cells' error, lane by lane.
HWY_INLINE V pull_tile(const CellTile& tile, const ReconstructionScratch::TileFit& fit,
                       const Quartet* segments, const ReconstructionSettings& settings,
                       ReconstructionScratch& scratch) {
  const D d;
  const std::size_t step = hn::Lanes(d);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const V falloff = hn::Set(d, 1.0F / (settings.sigma * settings.sigma));
  const V per_reach = hn::Set(d, 1.0F / kReach);
  V error = zero;
  alignas(64) float pulls[4 * 8];
  for (std::size_t c = 0; c < 8; c += step) {
    const Quartets at = gather(segments, fit.segment + c);
    const V pa = at.value[0], change = at.value[1], ex = at.value[2], ey = at.value[3];
    const V t = hn::Load(d, fit.along + c), phi = hn::Load(d, fit.phi + c);
    const V p = hn::MulAdd(t, change, pa);
    const V residual = hn::MulSub(phi, p, hn::Load(d, tile.pressure + c));
    const V w = hn::Load(d, tile.weight + c), wr = hn::Mul(w, residual);
    error = hn::MulAdd(wr, residual, error);

    // (P12): pressure out of reach of all paths
    const V target = hn::Load(d, tile.pressure + c);
    const V lack = hn::Max(hn::NegMulAdd(phi, per_reach, one), zero);
    const V wl = hn::Mul(hn::Set(d, settings.weight_coverage), hn::Mul(w, target));
    error = hn::MulAdd(wl, lack, error);

    const V common = hn::Mul(hn::Add(wr, wr), phi);
    const V reach_pull =
        hn::IfThenElseZero(hn::Gt(lack, zero), hn::Mul(hn::Mul(wl, per_reach), phi));
    const V k1 = hn::Mul(hn::MulSub(common, p, reach_pull), falloff);
    const V squared = hn::Max(hn::MulAdd(ex, ex, hn::Mul(ey, ey)), hn::Set(d, 1e-12F));
    const auto inside = hn::And(hn::Gt(t, zero), hn::Lt(t, one));
    const V k2 = hn::IfThenElseZero(inside, hn::Div(hn::Mul(common, change), squared));
    const V rest = hn::Sub(one, t), at_a = hn::MulSub(k1, rest, k2), at_b = hn::MulAdd(k1, t, k2);
    const V along_a = hn::Mul(k2, rest), along_b = hn::Mul(k2, t);
    const V dx = hn::Load(d, fit.dx + c), dy = hn::Load(d, fit.dy + c);
    hn::StoreInterleaved4(hn::NegMulAdd(along_a, ex, hn::Mul(at_a, dx)),
                          hn::NegMulAdd(along_a, ey, hn::Mul(at_a, dy)),
                          hn::NegMulAdd(along_b, ex, hn::Mul(at_b, dx)),
                          hn::NegMulAdd(along_b, ey, hn::Mul(at_b, dy)), d, pulls + 4 * c);
  }
  for (std::size_t c = 0; c < 8; ++c) {
    add_four(pulls + 4 * c, scratch.pull.data() + 4 * static_cast<std::size_t>(fit.segment[c]));
  }
  return error;
}

void Reconstruct(const CellTiles& cells, const Loops& loops, const ReconstructionSettings& settings,
                 Wanted wanted, ReconstructionScratch& scratch, Reconstruction& out) {
  const D d;
  Segments segments;
  scratch.clear(loops);
  collect(loops, segments);
  const std::vector<CellTile>& tiles = cells.tiles();
  const auto lanes = static_cast<std::size_t>(loops.lanes);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    fit_tile(tiles[i], settings.sigma, segments, scratch.fits[i], scratch);
  }
  solve_pressures(loops, settings, scratch, out);
  if (wanted == Wanted::Pressures) return;
  Quartet at_node[kMaxLoopNodes];
  for (std::size_t i = 0; i < segments.count; ++i) {
    const auto a = static_cast<std::size_t>(segments.node[i]), over = a + lanes;
    const std::size_t b = over < loops.nodes() ? over : over - loops.nodes();
    at_node[a] = {
        {out.pressure[a], out.pressure[b] - out.pressure[a], segments.ex[i], segments.ey[i]}};
  }
  V error = hn::Zero(d);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    error = hn::Add(error, pull_tile(tiles[i], scratch.fits[i], at_node, settings, scratch));
  }
  out.error = hn::GetLane(hn::SumOfLanes(d, error));
  gather_gradient(loops, settings, scratch, out);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::planning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::planning {
namespace {

HWY_EXPORT(Reconstruct);

void reconstruct(const CellTiles& cells, const Loops& loops, const ReconstructionSettings& settings,
                 Wanted wanted, ReconstructionScratch& scratch, Reconstruction& out) {
  HWY_DYNAMIC_DISPATCH(Reconstruct)(cells, loops, settings, wanted, scratch, out);
}

}  // namespace

ReconstructFunction fast_reconstruct() {
  const bool vectors = (hwy::SupportedTargets() & ~(HWY_SCALAR | HWY_EMU128)) != 0;
  return vectors ? reconstruct : reconstruct_plain;
}

}  // namespace prostm::planning
#endif  // HWY_ONCE
