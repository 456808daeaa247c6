#include "prostm/hand/hand_raster.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

constexpr int kMaxSubPoses = 16;
constexpr double kVelocityReach = 2.0;  // reach of the skin's velocity around it [cells]
constexpr int kRoot = 16;               // points along each edge of a task's block
constexpr double kFarthest = 1e3;       // no hand has a joint farther from the array [m]
constexpr double kSlack = 1e-3;         // above the error of single precision [cells]

bool is_usable(const Hand& hand) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!hand.position[j].allFinite() || !hand.velocity[j].allFinite() ||
        !std::isfinite(hand.radius[j]))
      return false;
    if (hand.position[j].cwiseAbs().maxCoeff() > kFarthest || hand.radius[j] > kFarthest)
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

CellBox common(const CellBox& a, const CellBox& b) {
  CellBox both;
  for (int axis = 0; axis < 3; ++axis) {
    both.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
    both.upper[axis] = std::min(a.upper[axis], b.upper[axis]);
  }
  return both;
}

/// The nodes of a box of cells.
CellBox nodes_of(CellBox box) {
  if (box.empty()) return {};
  for (int& upper : box.upper) ++upper;
  return box;
}

/// The cells around a range of nodes.
CellBox cells_around(CellBox nodes, const GridShape& grid) {
  if (nodes.empty()) return {};
  for (int a = 0; a < 3; ++a) {
    nodes.lower[a] = std::max(nodes.lower[a] - 1, 0);
    nodes.upper[a] = std::min(nodes.upper[a], cells_along(grid, a));
  }
  return nodes;
}

/// Calls row(j, k) for each row of the box.
template <class F>
void for_rows(const CellBox& box, F&& row) {
  if (box.empty()) return;
  for (int k = box.lower[2]; k < box.upper[2]; ++k) {
    for (int j = box.lower[1]; j < box.upper[1]; ++j) row(j, k);
  }
}

/// Blocks of kRoot³ points, aligned to the grid, that cover a box.
struct Roots {
  explicit Roots(const CellBox& box) {
    for (int a = 0; a < 3; ++a) {
      first[a] = box.lower[a] / kRoot;
      count[a] = box.empty() ? 0 : (box.upper[a] + kRoot - 1) / kRoot - first[a];
    }
  }
  int size() const { return count[0] * count[1] * count[2]; }
  CellBox operator[](int n) const {
    const int at[3] = {n % count[0], n / count[0] % count[1], n / (count[0] * count[1])};
    CellBox root;
    for (int a = 0; a < 3; ++a) {
      root.lower[a] = kRoot * (first[a] + at[a]);
      root.upper[a] = root.lower[a] + kRoot;
    }
    return root;
  }
  int first[3], count[3];
};

/// Descends from a block of points to the octants that can be within `limit` of a body, with the
/// bodies that can be nearest there, down to blocks of two points along each axis. For each of
/// these blocks it calls leaf(at, corners, nearest, within) with the first point, the points, their
/// nearest bodies, and a mask: bit c of `within` is set if point c is in `range` and within the
/// limit.
template <class Leaf>
class Descent {
 public:
  /// @param offset 0 for the grid's nodes, 0.5 for the centres of its cells. @param limit [m]
  Descent(const BodySet& bodies, const GridShape& grid, double offset, const CellBox& range,
          double limit, const Leaf& leaf)
      : bodies_(bodies),
        kernels_(fast_body_kernels()),
        cell_(grid.cell),
        range_(range),
        limit_(static_cast<float>(limit)),
        leaf_(leaf) {
    for (int a = 0; a < 3; ++a) start_[a] = grid.p_DF[a] + grid.cell * offset - bodies.origin()[a];
  }

  void from(const CellBox& root) const {
    BodyList every;
    every.count = static_cast<int>(bodies_.size());
    for (int n = 0; n < every.count; ++n) every.body[n] = static_cast<std::uint8_t>(n);
    if (every.count > 0) descend(root.lower, root.upper[0] - root.lower[0], every);
  }

 private:
  void descend(const int* at, int size, const BodyList& list) const {
    // the corners are the points of a block of two, or the middles of a larger block's octants
    CubeCorners corners{};
    for (int a = 0; a < 3; ++a)
      corners.centre[a] = static_cast<float>(start_[a] + cell_ * (at[a] + 0.5 * (size - 1)));
    corners.half = static_cast<float>(0.25 * size * cell_);
    if (size == 2) {
      touch(at, corners, list);
      return;
    }
    const double reach = (0.5 * std::sqrt(3.0) * (size / 2 - 1) + kSlack) * cell_;
    std::uint8_t near[BodySet::kCapacity];
    kernels_.cull(bodies_, list, corners, static_cast<float>(reach), limit_, near);
    for (unsigned octant = 0; octant < 8; ++octant) {
      BodyList part;
      for (int n = 0; n < list.count; ++n) {
        part.body[part.count] = list.body[n];
        part.count += near[n] >> octant & 1;
      }
      int lower[3];
      if (part.count > 0 && octant_of(at, size / 2, octant, lower)) descend(lower, size / 2, part);
    }
  }

  /// Sets `lower` to the octant's first point; false if no point of it is in the range.
  bool octant_of(const int* at, int size, unsigned octant, int* lower) const {
    for (int a = 0; a < 3; ++a) {
      lower[a] = at[a] + ((octant >> a & 1U) != 0 ? size : 0);
      if (lower[a] >= range_.upper[a] || lower[a] + size <= range_.lower[a]) return false;
    }
    return true;
  }

  void touch(const int* at, const CubeCorners& corners, const BodyList& list) const {
    NearestBodies nearest;
    kernels_.nearest(bodies_, list, corners, nearest);
    unsigned within = 0;
    for (unsigned c = 0; c < 8; ++c) {
      int point[3];
      if (nearest.distance[c] <= limit_ && octant_of(at, 1, c, point)) within |= 1U << c;
    }
    if (within != 0) leaf_(at, corners, nearest, within);
  }

  const BodySet& bodies_;
  const BodyKernels& kernels_;
  double cell_, start_[3];
  CellBox range_;
  float limit_;
  const Leaf& leaf_;
};

/// Calls f(c, i, j, k) for each point of a block of two whose bit is set.
template <class F>
void for_points(const int* at, unsigned within, F&& f) {
  for (unsigned c = 0; c < 8; ++c) {
    if ((within >> c & 1U) == 0) continue;
    f(c, at[0] + static_cast<int>(c & 1U), at[1] + static_cast<int>(c >> 1 & 1U),
      at[2] + static_cast<int>(c >> 2));
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
  solid_.assign(grid.cell_count(), 0);
  move_to(grid.p_DF);
  sub_poses_.resize(2 * kMaxSubPoses);
  node_ranges_.reserve(2);
}

void HandRasteriser::move_to(const Vec3& p_DF) noexcept {
  GridShape& grid = raster_.grid;
  grid.p_DF = p_DF;
  middle_ = p_DF + 0.5 * grid.cell * Vec3(grid.nx, grid.ny, grid.nz);
}

void HandRasteriser::rasterise(const HandFrame& frame, WorkerPool& pool) noexcept {
  set_shapes(frame);
  const CellBox old = raster_.box;
  place_box();

  // blocks of nodes and of cells that held something before or hold something now
  CellBox both = raster_.box.empty() ? old : raster_.box;
  include(old, both);
  if (both.empty()) return;
  const Roots nodes(nodes_of(both)), cells(both);
  pool.run(nodes.size() + cells.size(), [&](int task) {
    if (task < nodes.size()) {
      fill_nodes(old, nodes[task]);
    } else {
      fill_cells(old, cells[task - nodes.size()]);
    }
  });
}

void HandRasteriser::set_shapes(const HandFrame& frame) noexcept {
  shapes_.clear();
  bodies_.clear(middle_);
  node_ranges_.clear();
  sub_pose_count_ = 0;
  HandFrame usable;
  for (const Hand& hand : frame.hands) {
    if (!is_usable(hand)) continue;
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
    pose.bodies.clear(middle_);
    pose.bodies.add(pose.shape);
    // between poses one cell apart, a 5 mm fingertip leaves scallops of less than a fifth of a cell
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
  const auto take = [&](const CellBox& range) {
    if (raster_.box.empty()) raster_.box = range;
    include(range, raster_.box);
  };
  for (const CellBox& nodes : node_ranges_) take(cells_around(nodes, raster_.grid));
  for (std::size_t n = 0; n < sub_pose_count_; ++n) take(sub_poses_[n].cells);
  if (raster_.box.empty()) raster_.box = CellBox();
}

void HandRasteriser::fill_nodes(const CellBox& old, const CellBox& root) noexcept {
  const GridShape& grid = raster_.grid;
  const CellBox stale = common(nodes_of(old), root);
  for_rows(stale, [&](int j, int k) {
    std::fill_n(&raster_.node_distance[grid.node_index(stale.lower[0], j, k)],
                stale.upper[0] - stale.lower[0], HandRaster::kFar);
  });
  const auto reached = [&](const CellBox& range) { return !common(range, root).empty(); };
  if (std::none_of(node_ranges_.begin(), node_ranges_.end(), reached)) return;
  const auto leaf = [&](const int* at, const CubeCorners&, const NearestBodies& nearest,
                        unsigned within) {
    for_points(at, within, [&](unsigned c, int i, int j, int k) {
      raster_.node_distance[grid.node_index(i, j, k)] = nearest.distance[c];
    });
  };
  Descent(bodies_, grid, 0.0, nodes_of(raster_.box), band_ * grid.cell, leaf).from(root);
}

void HandRasteriser::fill_cells(const CellBox& old, const CellBox& root) noexcept {
  const GridShape& grid = raster_.grid;
  const CellBox stale = common(old, root);
  for_rows(stale, [&](int j, int k) {
    const std::size_t row = grid.cell_index(stale.lower[0], j, k);
    const int count = stale.upper[0] - stale.lower[0];
    for (std::vector<float>& component : raster_.velocity)
      std::fill_n(&component[row], count, 0.0F);
    std::fill_n(&raster_.swept[row], count, std::uint8_t{0});
    std::fill_n(&solid_[row], count, std::uint8_t{0});
  });
  const auto reached = [&](const CellBox& nodes) {
    return !common(cells_around(nodes, grid), root).empty();
  };
  if (std::any_of(node_ranges_.begin(), node_ranges_.end(), reached)) set_cells(root);
  for (std::size_t n = 0; n < sub_pose_count_; ++n) sweep(sub_poses_[n], root);
}

void HandRasteriser::set_cells(const CellBox& root) noexcept {
  const GridShape& grid = raster_.grid;
  const auto leaf = [&](const int* at, const CubeCorners& corners, const NearestBodies& nearest,
                        unsigned within) {
    alignas(32) float velocity[3][8];
    fast_body_kernels().velocity(bodies_, nearest, corners, within, velocity);
    for_points(at, within, [&](unsigned c, int i, int j, int k) {
      const std::size_t cell = grid.cell_index(i, j, k);
      for (int a = 0; a < 3; ++a) raster_.velocity[a][cell] = velocity[a][c];
      solid_[cell] = nearest.distance[c] <= 0.0F ? 1 : 0;
    });
  };
  Descent(bodies_, grid, 0.5, raster_.box, kVelocityReach * grid.cell, leaf).from(root);
}

void HandRasteriser::sweep(const SubPose& pose, const CellBox& root) noexcept {
  const GridShape& grid = raster_.grid;
  const CellBox range = common(pose.cells, raster_.box);
  if (common(range, root).empty()) return;
  const auto leaf = [&](const int* at, const CubeCorners& corners, const NearestBodies& touch,
                        unsigned within) {
    // not yet marked by a newer pose, and free now
    unsigned swept = 0;
    for_points(at, within, [&](unsigned c, int i, int j, int k) {
      const std::size_t cell = grid.cell_index(i, j, k);
      if (raster_.swept[cell] == 0 && solid_[cell] == 0) swept |= 1U << c;
    });
    if (swept == 0) return;
    alignas(32) float velocity[3][8];
    fast_body_kernels().velocity(pose.bodies, touch, corners, swept, velocity);
    for_points(at, swept, [&](unsigned c, int i, int j, int k) {
      const std::size_t cell = grid.cell_index(i, j, k);
      raster_.swept[cell] = 1;
      for (int a = 0; a < 3; ++a) raster_.velocity[a][cell] = velocity[a][c];
    });
  };
  Descent(pose.bodies, grid, 0.5, range, pose.margin, leaf).from(root);
}

}  // namespace prostm
