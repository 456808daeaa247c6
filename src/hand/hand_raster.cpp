#include "hand/hand_raster.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "core/require.hpp"

namespace prostm {
namespace {

constexpr int kMaxSubPoses = 16;
constexpr double kVelocityReach = 2.0;   // how far from the skin its velocity is told [cells]
constexpr float kDiagonal = 1.7320509F;  // of a cell [cells], rounded up
constexpr int kSlab = 4;                 // planes in one task
static_assert(BodySet::kCapacity < 255, "a node's owner is one byte");

bool is_finite(const Hand& hand) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!hand.position[j].allFinite() || !hand.velocity[j].allFinite() ||
        !std::isfinite(hand.radius[j]))
      return false;
  }
  return true;
}

/// A coordinate on the grid as an index from 0 to n.
int clipped(double x, int n) {
  return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(n)));
}

int cells_along(const GridShape& grid, int axis) {
  return axis == 0 ? grid.nx : axis == 1 ? grid.ny : grid.nz;
}

void include(const CellBox& part, CellBox& whole) {
  if (part.empty()) return;
  for (int a = 0; a < 3; ++a) {
    whole.lower[a] = std::min(whole.lower[a], part.lower[a]);
    whole.upper[a] = std::max(whole.upper[a], part.upper[a]);
  }
}

bool has_plane(const CellBox& box, int k, int extra = 0) {
  return !box.empty() && k >= box.lower[2] && k < box.upper[2] + extra;
}

/// Points of the grid by index: nodes (offset 0) or centres of cells (offset 0.5).
struct Points {
  const GridShape& grid;
  double offset;
  Vec3 at(int i, int j, int k) const {
    return grid.p_DF + grid.cell * Vec3(i + offset, j + offset, k + offset);
  }
};

/// Follows what can be within `limit` of a body, from a block of points to its octants, with the
/// bodies that can be nearest there, down to blocks of two points along each axis. Calls leaf(i, j,
/// k, point, nearest) for each point within the limit. `from` holds distances at `origin`.
template <class Leaf>
void descend(const BodySet& bodies, const BodySet::List& from, const Vec3& origin,
             const Points& points, const CellBox& block, double limit, const Leaf& leaf) {
  const int *lo = block.lower, *up = block.upper;
  const Vec3 low = points.at(lo[0], lo[1], lo[2]),
             high = points.at(up[0] - 1, up[1] - 1, up[2] - 1);
  const Vec3 centre = 0.5 * (low + high);
  const double reach = 0.5 * (high - low).norm();
  BodySet::List kept;
  const double distance =
      bodies.nearest(centre, from, (centre - origin).norm(), reach, kept).distance;
  if (distance - reach > limit) return;
  if (up[0] - lo[0] <= 2 && up[1] - lo[1] <= 2 && up[2] - lo[2] <= 2) {
    for (int k = lo[2]; k < up[2]; ++k) {
      for (int j = lo[1]; j < up[1]; ++j) {
        for (int i = lo[0]; i < up[0]; ++i) {
          const Vec3 point = points.at(i, j, k);
          const BodySet::Candidate nearest = bodies.nearest(point, kept, reach);
          if (nearest.distance <= limit) leaf(i, j, k, point, nearest);
        }
      }
    }
    return;
  }
  // the longest axes are cut, at powers of two, so that blocks become cubes and the last ones are
  // whole
  const auto size = [&](int a) { return static_cast<unsigned>(up[a] - lo[a]); };
  const unsigned longest = std::bit_ceil(std::max({size(0), size(1), size(2)}));
  int middle[3];
  for (int a = 0; a < 3; ++a) {
    middle[a] = std::bit_ceil(size(a)) == longest ? lo[a] + static_cast<int>(longest / 2) : up[a];
  }
  for (unsigned octant = 0; octant < 8; ++octant) {
    CellBox part = block;
    for (int a = 0; a < 3; ++a)
      ((octant >> a & 1U) != 0 ? part.lower[a] : part.upper[a]) = middle[a];
    if (!part.empty()) descend(bodies, kept, centre, points, part, limit, leaf);
  }
}

}  // namespace

HandRasteriser::HandRasteriser(const GridShape& grid, double band) : band_(band) {
  require_between("band", band, 2.0, 16.0, "cells");
  if (grid.nx < 1 || grid.ny < 1 || grid.nz < 1 || !(grid.cell > 0.0)) {
    std::ostringstream sentence;
    sentence
        << "a grid of " << grid.nx << " x " << grid.ny << " x " << grid.nz << " cells of "
        << grid.cell
        << " m cannot hold a hand; it must have at least one cell along each axis, larger than 0 m";
    throw std::invalid_argument(sentence.str());
  }
  raster_.grid = grid;
  raster_.node_distance.assign(grid.node_count(), HandRaster::kFar);
  for (std::vector<float>& component : raster_.velocity) component.assign(grid.cell_count(), 0.0F);
  raster_.swept.assign(grid.cell_count(), 0);
  owner_.assign(grid.node_count(), 0);
  sub_poses_.resize(2 * kMaxSubPoses);
  node_ranges_.reserve(2);
}

void HandRasteriser::rasterise(const HandFrame& frame, WorkerPool& pool) noexcept {
  set_shapes(frame);
  const CellBox old = raster_.box;
  place_box();

  // planes that held something before or hold something now
  CellBox both = raster_.box.empty() ? old : raster_.box;
  include(old, both);
  if (both.empty()) return;
  const int first = both.lower[2], planes = both.upper[2] - first, nodes = planes + 1;
  pool.run((nodes + kSlab - 1) / kSlab, [&](int task) {
    fill_nodes(old, first + task * kSlab, std::min(first + (task + 1) * kSlab, first + nodes));
  });
  pool.run((planes + kSlab - 1) / kSlab, [&](int task) {
    fill_cells(old, first + task * kSlab, std::min(first + (task + 1) * kSlab, first + planes));
  });
}

void HandRasteriser::set_shapes(const HandFrame& frame) noexcept {
  shapes_.clear();
  bodies_.clear();
  node_ranges_.clear();
  sub_pose_count_ = 0;
  HandFrame usable;
  for (const Hand& hand : frame.hands) {
    if (!is_finite(hand)) continue;
    usable.hands.push_back(hand);
    shapes_.emplace_back(hand);
    bodies_.add(shapes_.back());
    node_ranges_.push_back(range_of(shapes_.back(), band_ * raster_.grid.cell, 0.0));
    for (const Hand& last : previous_.hands) {
      if (last.id == hand.id && last.side == hand.side) add_sub_poses(last, hand);
    }
  }
  previous_ = usable;
}

void HandRasteriser::add_sub_poses(const Hand& from, const Hand& to) noexcept {
  double motion = 0.0;
  for (std::size_t j = 0; j < kJointCount; ++j)
    motion = std::max(motion, (to.position[j] - from.position[j]).norm());
  if (motion == 0.0) return;
  const double cells = std::ceil(motion / raster_.grid.cell);
  const int count = static_cast<int>(std::clamp(cells, 1.0, static_cast<double>(kMaxSubPoses)));

  Hand hand = to;
  for (int n = count - 1; n >= 0; --n) {
    const double u = static_cast<double>(n) / count;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      hand.position[j] = from.position[j] + u * (to.position[j] - from.position[j]);
      hand.velocity[j] = from.velocity[j] + u * (to.velocity[j] - from.velocity[j]);
      hand.radius[j] = from.radius[j] + u * (to.radius[j] - from.radius[j]);
    }
    SubPose& pose = sub_poses_[sub_pose_count_++];
    pose.shape.set(hand);
    pose.bodies.clear();
    pose.bodies.add(pose.shape);
    // between poses a cell apart the skin of a fingertip of 5 mm leaves scallops of less than a
    // fifth of a cell
    pose.margin = count > 1 ? 0.2 * raster_.grid.cell : 0.0;
    pose.cells = range_of(pose.shape, pose.margin, 0.5);
  }
}

/// Points of the grid within `margin` of the shape's bounds: nodes (offset 0) or centres of cells
/// (offset 0.5).
CellBox HandRasteriser::range_of(const HandShape& shape, double margin,
                                 double offset) const noexcept {
  const GridShape& grid = raster_.grid;
  CellBox range;
  for (int a = 0; a < 3; ++a) {
    const int points = cells_along(grid, a) + (offset == 0.0 ? 1 : 0);
    const double low = (shape.lower()[a] - margin - grid.p_DF[a]) / grid.cell - offset;
    const double high = (shape.upper()[a] + margin - grid.p_DF[a]) / grid.cell - offset;
    range.lower[a] = clipped(std::ceil(low), points);
    range.upper[a] = clipped(std::floor(high) + 1.0, points);
  }
  return range;
}

void HandRasteriser::place_box() noexcept {
  raster_.box = CellBox();
  const auto take = [&](CellBox range, int below) {
    for (int a = 0; a < 3; ++a) {
      range.lower[a] = std::max(range.lower[a] - below, 0);
      range.upper[a] = std::min(range.upper[a], cells_along(raster_.grid, a));
    }
    if (raster_.box.empty()) raster_.box = range;
    include(range, raster_.box);
  };
  // the cells around a node lie from one below it to itself
  for (const CellBox& nodes : node_ranges_) {
    if (!nodes.empty()) take(nodes, 1);
  }
  for (std::size_t n = 0; n < sub_pose_count_; ++n) take(sub_poses_[n].cells, 0);
  if (raster_.box.empty()) raster_.box = CellBox();
}

void HandRasteriser::fill_nodes(const CellBox& old, int first, int last) noexcept {
  const GridShape& grid = raster_.grid;
  for (int k = first; k < last; ++k) {
    if (!has_plane(old, k, 1)) continue;
    for (int j = old.lower[1]; j <= old.upper[1]; ++j) {
      const auto row = static_cast<std::ptrdiff_t>(grid.node_index(old.lower[0], j, k));
      const auto count = static_cast<std::size_t>(old.upper[0] - old.lower[0] + 1);
      std::fill_n(raster_.node_distance.begin() + row, count, HandRaster::kFar);
      std::fill_n(owner_.begin() + row, count, std::uint8_t{0});
    }
  }

  // each hand's box may overlap the other's; there all bodies count, so a node that is met twice is
  // only written twice
  for (CellBox range : node_ranges_) {
    range.lower[2] = std::max(range.lower[2], first);
    range.upper[2] = std::min(range.upper[2], last);
    if (range.empty()) continue;
    descend(bodies_, bodies_.all(), Vec3::Zero(), Points{grid, 0.0}, range, band_ * grid.cell,
            [&](int i, int j, int k, const Vec3&, const BodySet::Candidate& nearest) {
              const std::size_t node = grid.node_index(i, j, k);
              raster_.node_distance[node] = static_cast<float>(nearest.distance);
              owner_[node] = static_cast<std::uint8_t>(nearest.body + 1);
            });
  }
}

void HandRasteriser::fill_cells(const CellBox& old, int first, int last) noexcept {
  const GridShape& grid = raster_.grid;
  for (int k = first; k < last; ++k) {
    if (!has_plane(old, k)) continue;
    for (int j = old.lower[1]; j < old.upper[1]; ++j) {
      const auto row = static_cast<std::ptrdiff_t>(grid.cell_index(old.lower[0], j, k));
      const auto count = static_cast<std::size_t>(old.upper[0] - old.lower[0]);
      for (std::vector<float>& component : raster_.velocity) {
        std::fill_n(component.begin() + row, count, 0.0F);
      }
      std::fill_n(raster_.swept.begin() + row, count, std::uint8_t{0});
    }
  }
  // the cells around a node lie from one below it to itself
  for (const CellBox& nodes : node_ranges_) {
    if (nodes.empty()) continue;
    for (int k = std::max(nodes.lower[2] - 1, first); k < std::min({nodes.upper[2], grid.nz, last});
         ++k) {
      for (int j = std::max(nodes.lower[1] - 1, 0); j < std::min(nodes.upper[1], grid.ny); ++j) {
        for (int i = std::max(nodes.lower[0] - 1, 0); i < std::min(nodes.upper[0], grid.nx); ++i) {
          find_velocity(i, j, k);
        }
      }
    }
  }
  for (std::size_t n = 0; n < sub_pose_count_; ++n) sweep(sub_poses_[n], first, last);
}

std::array<std::size_t, 8> HandRasteriser::corners(int i, int j, int k) const noexcept {
  const GridShape& grid = raster_.grid;
  const std::size_t row = static_cast<std::size_t>(grid.nx) + 1;
  const std::size_t plane = row * (static_cast<std::size_t>(grid.ny) + 1);
  const std::size_t first = grid.node_index(i, j, k);
  return {first,         first + 1,         first + row,         first + row + 1,
          first + plane, first + plane + 1, first + plane + row, first + plane + row + 1};
}

void HandRasteriser::find_velocity(int i, int j, int k) noexcept {
  // the body that is nearest at the corner nearest to a hand is taken for the one nearest to the
  // cell
  const GridShape& grid = raster_.grid;
  const float reach = static_cast<float>(kVelocityReach * grid.cell);
  if (raster_.node_distance[grid.node_index(i, j, k)] >
      reach + kDiagonal * static_cast<float>(grid.cell))
    return;
  std::size_t nearest = grid.node_index(i, j, k);
  for (const std::size_t node : corners(i, j, k)) {
    if (raster_.node_distance[node] < raster_.node_distance[nearest]) nearest = node;
  }
  if (raster_.node_distance[nearest] > reach || owner_[nearest] == 0) return;
  const Vec3 velocity = bodies_.query(owner_[nearest] - 1U, grid.cell_centre(i, j, k)).velocity;
  const std::size_t cell = grid.cell_index(i, j, k);
  for (int a = 0; a < 3; ++a) raster_.velocity[a][cell] = static_cast<float>(velocity[a]);
}

bool HandRasteriser::is_solid(int i, int j, int k) const noexcept {
  // a centre is half a diagonal from its corners, and distances change at most as fast
  const float half_diagonal = 0.5F * kDiagonal * static_cast<float>(raster_.grid.cell);
  for (const std::size_t node : corners(i, j, k)) {
    if (raster_.node_distance[node] < -half_diagonal) return true;
    if (raster_.node_distance[node] > half_diagonal) return false;
  }
  const Vec3 centre = raster_.grid.cell_centre(i, j, k);
  return std::any_of(shapes_.begin(), shapes_.end(),
                     [&](const HandShape& shape) { return shape.distance(centre) <= 0.0; });
}

void HandRasteriser::sweep(const SubPose& pose, int first, int last) noexcept {
  const GridShape& grid = raster_.grid;
  CellBox range = pose.cells;
  range.lower[2] = std::max(range.lower[2], first);
  range.upper[2] = std::min(range.upper[2], last);
  if (range.empty()) return;
  descend(pose.bodies, pose.bodies.all(), Vec3::Zero(), Points{grid, 0.5}, range, pose.margin,
          [&](int i, int j, int k, const Vec3& centre, const BodySet::Candidate& touch) {
            // not yet marked by a newer pose, and free now
            const std::size_t cell = grid.cell_index(i, j, k);
            if (raster_.swept[cell] != 0 || is_solid(i, j, k)) return;
            raster_.swept[cell] = 1;
            const Vec3 velocity = pose.bodies.query(touch.body, centre).velocity;
            for (int a = 0; a < 3; ++a) raster_.velocity[a][cell] = static_cast<float>(velocity[a]);
          });
}

}  // namespace prostm
