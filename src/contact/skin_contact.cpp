#include "contact/skin_contact.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace prostm {
namespace {

constexpr double kMinNormalZ =
    0.25;  // a plane is never steeper than 75°: an edge-on hand has no area towards the array
constexpr double kMarchStep = 0.5;  // of a ray through the distance field [cells]

/// The hand's signed distance at a point, trilinear between nodes; far outside the grid.
double distance_at(const HandRaster& raster, const Vec3& p_D) {
  const GridShape& g = raster.grid;
  const Vec3 q = (p_D - g.p_DF) / g.cell;
  if (!(q.x() >= 0 && q.y() >= 0 && q.z() >= 0 && q.x() <= g.nx && q.y() <= g.ny &&
        q.z() <= g.nz)) {
    return HandRaster::kFar;
  }
  const int i = std::min(static_cast<int>(q.x()), g.nx - 1),
            j = std::min(static_cast<int>(q.y()), g.ny - 1),
            k = std::min(static_cast<int>(q.z()), g.nz - 1);
  const double u = q.x() - i, v = q.y() - j, w = q.z() - k;
  const float* d = raster.node_distance.data();
  const auto along_x = [&](int jj, int kk) {
    const std::size_t n = g.node_index(i, jj, kk);
    return (1 - u) * static_cast<double>(d[n]) + u * static_cast<double>(d[n + 1]);
  };
  const double below = (1 - v) * along_x(j, k) + v * along_x(j + 1, k);
  const double above = (1 - v) * along_x(j, k + 1) + v * along_x(j + 1, k + 1);
  return (1 - w) * below + w * above;
}

/// First crossing from outside to inside along start + t·direction, 0 <= t <= t_max; negative when
/// there is none.
double march(const HandRaster& raster, const Vec3& start, const Vec3& direction, double t_max) {
  const double step = kMarchStep * raster.grid.cell;
  double t0 = 0.0, d0 = distance_at(raster, start);
  if (d0 < 0.0) return -1.0;  // starts inside: this skin does not face the array
  while (t0 < t_max) {
    const double t1 = t0 + step;
    const double d1 = distance_at(raster, start + t1 * direction);
    if (d1 < 0.0) return t0 + step * d0 / (d0 - d1);
    t0 = t1;
    d0 = d1;
  }
  return -1.0;
}

}  // namespace

void ContactSettings::visit(SettingsVisitor& v) {
  v.field("offset_cells", offset_cells);
  v.field("time_constant", time_constant);
}

SkinContact::SkinContact(const ContactSettings& settings, const GridShape& grid)
    : settings_(settings), grid_(grid), max_side_(2 * std::max({grid.nx, grid.ny, grid.nz})) {
  require_between("offset_cells", settings.offset_cells, 0.5, 4.0);
  require_between("time_constant", settings.time_constant, 0.0, 10.0, "s");
  visible_.reserve(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));
  pressure_.assign(grid.cell_count(), 0.0F);
  fluid_.assign(grid.cell_count(), 0);
}

ContactStats SkinContact::extract(const Fluid& fluid, const HandRaster& raster,
                                  const HandFrame& hands, double dt, TargetFrame& out) noexcept {
  ContactStats stats;
  smooth_pressure(fluid, dt);
  shapes_.clear();
  for (const Hand& hand : hands.hands) {
    shapes_.emplace_back(hand);
    for (const Vec3& p_D : hand.position) {
      const Vec3 q = (p_D - grid_.p_DF) / grid_.cell;
      const bool inside =
          (q.array() >= 0.0).all() && q.x() <= grid_.nx && q.y() <= grid_.ny && q.z() <= grid_.nz;
      stats.joints_outside += inside ? 0 : 1;
    }
  }

  out.time = hands.time;
  std::size_t patches = 0;
  for (int hand = 0; hand < static_cast<int>(shapes_.size()); ++hand) {
    find_visible(raster, hand);
    if (visible_.empty()) continue;
    if (out.patches.size() == patches) out.patches.emplace_back();
    TargetField& patch = out.patches[patches];
    if (!place_patch(raster, patch)) continue;
    const int skin = gather(raster, hand, patch);
    if (skin == 0) continue;
    fill_heights(patch);
    stats.skin_cells += skin;
    ++patches;
  }
  while (out.patches.size() > patches) out.patches.pop_back();
  return stats;
}

void SkinContact::find_visible(const HandRaster& raster, int hand) {
  visible_.clear();
  if (raster.box.empty()) return;
  // start below the box of the hand, but inside the grid
  const int bottom = std::max(raster.box.lower[2] - 1, 0);
  const double height = (raster.box.upper[2] - bottom) * grid_.cell;
  for (int j = raster.box.lower[1]; j < raster.box.upper[1]; ++j) {
    for (int i = raster.box.lower[0]; i < raster.box.upper[0]; ++i) {
      Vec3 p_D = grid_.cell_centre(i, j, bottom);
      p_D.z() = grid_.node(i, j, bottom).z();
      const double t = march(raster, p_D, Vec3::UnitZ(), height);
      if (t < 0.0) continue;
      p_D.z() += t;
      if (belongs_to(p_D, hand)) visible_.push_back(p_D);
    }
  }
}

bool SkinContact::belongs_to(const Vec3& p_D, int hand) const {
  if (shapes_.size() == 1) return true;
  const double first = shapes_[0].distance(p_D), second = shapes_[1].distance(p_D);
  return (hand == 0) == (first <= second);
}

bool SkinContact::place_patch(const HandRaster& raster, TargetField& patch) const {
  // (C1) plane through the mean, normal to the direction of least spread, towards +z
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : visible_) mean += p;
  mean /= static_cast<double>(visible_.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : visible_) spread += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  Vec3 normal = eigen.eigenvectors().col(0);
  if (normal.z() < 0.0) normal = -normal;
  const bool flat_enough =
      eigen.eigenvalues()(1) > 4.0 * grid_.cell * grid_.cell;  // not a line or a point
  if (!flat_enough || normal.z() < kMinNormalZ) normal = Vec3::UnitZ();

  // (C2) x axis: D's x projected; origin: the foot of F's origin
  const Vec3 x = (Vec3::UnitX() - normal.x() * normal).normalized();
  patch.X_DP.linear() << x, normal.cross(x), normal;
  patch.X_DP.translation() = grid_.p_DF + normal * normal.dot(mean - grid_.p_DF);
  patch.X_DP.makeAffine();

  // bounds of the visible skin, on multiples of the cell, with a margin that the slant of the rays
  // needs
  Vec2 lower = Vec2::Constant(1e9), upper = Vec2::Constant(-1e9);
  for (const Vec3& p : visible_) {
    const Vec2 q = (patch.X_DP.inverse() * p).head<2>();
    lower = lower.cwiseMin(q);
    upper = upper.cwiseMax(q);
  }
  const double h = raster.grid.cell;
  const Vec2 first = ((lower.array() / h).floor() - 1.0).matrix(),
             last = ((upper.array() / h).ceil() + 1.0).matrix();
  const int cols = static_cast<int>(last.x() - first.x()) + 1,
            rows = static_cast<int>(last.y() - first.y()) + 1;
  if (cols > max_side_ || rows > max_side_) return false;
  patch.cell = h;
  patch.origin = h * first;
  patch.resize(rows, cols);
  return true;
}

int SkinContact::gather(const HandRaster& raster, int hand, TargetField& patch) const {
  // (C3) from below the lowest to above the highest visible point, along the normal
  const Vec3 normal = patch.X_DP.linear().col(2);
  double lowest = 1e9, highest = -1e9;
  for (const Vec3& p : visible_) {
    const double z = normal.dot(p - patch.X_DP.translation());
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  lowest -= 1.5 * patch.cell;
  const double reach = highest - lowest + 0.5 * patch.cell;

  int skin = 0;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const Vec2 x = patch.position(row, col);
      const Vec3 start = patch.X_DP * Vec3(x.x(), x.y(), lowest);
      const double t = march(raster, start, normal, reach);
      if (t < 0.0) continue;
      const Vec3 p_D = start + t * normal;
      if (!belongs_to(p_D, hand)) continue;
      const std::size_t cell = patch.index(row, col);
      patch.skin[cell] = 1;
      patch.height[cell] = lowest + t;
      // (C4)
      patch.pressure[cell] =
          std::max(0.0, pressure_at(p_D - settings_.offset_cells * patch.cell * normal));
      ++skin;
    }
  }
  return skin;
}

void SkinContact::smooth_pressure(const Fluid& fluid, double dt) {
  const auto pressure = fluid.pressure();
  const auto known = fluid.fluid_cells();
  const bool smooth = settings_.time_constant > 0.0;
  const auto share =
      static_cast<float>(smooth ? 1.0 - std::exp(-dt / settings_.time_constant) : 1.0);
  for (std::size_t c = 0; c < pressure_.size(); ++c) {
    // a cell that has just become fluid has no history
    const float weight = fluid_[c] != 0 ? share : 1.0F;
    pressure_[c] += weight * (pressure[c] - pressure_[c]);
    fluid_[c] = known[c];
  }
}

double SkinContact::pressure_at(const Vec3& p_D) const {
  // trilinear between cell centres; cells inside a hand are left out and the weights renormalised
  const Vec3 q = (p_D - grid_.p_DF) / grid_.cell - Vec3::Constant(0.5);
  const int i = static_cast<int>(std::floor(q.x())), j = static_cast<int>(std::floor(q.y())),
            k = static_cast<int>(std::floor(q.z()));
  double sum = 0.0, weights = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int ci = i + (corner & 1), cj = j + (corner >> 1 & 1), ck = k + (corner >> 2);
    if (ci < 0 || cj < 0 || ck < 0 || ci >= grid_.nx || cj >= grid_.ny || ck >= grid_.nz) continue;
    const std::size_t c = grid_.cell_index(ci, cj, ck);
    if (fluid_[c] == 0) continue;
    const double weight =
        (1.0 - std::abs(q.x() - ci)) * (1.0 - std::abs(q.y() - cj)) * (1.0 - std::abs(q.z() - ck));
    sum += weight * static_cast<double>(pressure_[c]);
    weights += weight;
  }
  return weights > 1e-6 ? sum / weights : 0.0;
}

}  // namespace prostm
