#include "contact/skin_contact.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace prostm {
namespace {

constexpr double kMinNormalZ =
    0.25;  // a plane is never steeper than 75°: an edge-on hand has no area towards the array
constexpr double kNearSkin = 1.5;  // a crossing is at most this far from the skin itself: √3/2 that
                                   // trilinear values err by, and a step [cells]

}  // namespace

void ContactSettings::visit(SettingsVisitor& v) {
  v.field("offset_cells", offset_cells);
  v.field("time_constant", time_constant);
  v.field("touch_palm", touch_palm);
  v.field("touch_finger", touch_finger);
  v.field("touch_tip", touch_tip);
}

SkinContact::SkinContact(const ContactSettings& settings, const GridShape& grid)
    : settings_(settings),
      has_weights_(settings.touch_palm != settings.touch_finger ||
                   settings.touch_finger != settings.touch_tip),
      grid_(grid),
      max_side_(2 * std::max({grid.nx, grid.ny, grid.nz})),
      rays_(grid) {
  require_between("offset_cells", settings.offset_cells, 0.5, 4.0);
  require_between("time_constant", settings.time_constant, 0.0, 10.0, "s");
  // above 0, since a hand may show but one part of it
  require_between("touch_palm", settings.touch_palm, 0.001, 1000.0);
  require_between("touch_finger", settings.touch_finger, 0.001, 1000.0);
  require_between("touch_tip", settings.touch_tip, 0.001, 1000.0);
  for (std::vector<Vec3>& points : visible_)
    points.reserve(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));
  queue_.reserve(max_cells());
  if (settings.time_constant == 0.0) return;
  smoothed_.assign(grid.cell_count(), 0.0F);
  was_fluid_.assign(grid.cell_count(), 0);
}

ContactStats SkinContact::extract(const Fluid& fluid, const HandRaster& raster,
                                  const HandFrame& hands, double dt, TargetFrame& out) noexcept {
  ContactStats stats;
  take_pressure(fluid, dt);
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
  rays_.set(raster);
  owner_.set({shapes_.data(), shapes_.size()}, kNearSkin * grid_.cell);
  find_visible();
  std::size_t patches = 0;
  for (std::size_t hand = 0; hand < shapes_.size(); ++hand) {
    if (visible_[hand].empty()) continue;
    if (out.patches.size() == patches) out.patches.emplace_back();
    TargetField& patch = out.patches[patches];
    if (!place_patch(visible_[hand], patch)) continue;
    const int skin = gather(static_cast<int>(hand), patch);
    if (skin == 0) continue;
    fill_heights(patch, queue_);
    stats.skin_cells += skin;
    ++patches;
  }
  while (out.patches.size() > patches) out.patches.pop_back();
  return stats;
}

void SkinContact::find_visible() {
  for (std::vector<Vec3>& points : visible_) points.clear();
  if (shapes_.empty()) return;
  const CellBox& box = rays_.box();
  for (int j = box.lower[1]; j < box.upper[1]; ++j) {
    for (int i = box.lower[0]; i < box.upper[0]; ++i) {
      Vec3 p_D = grid_.cell_centre(i, j, 0);
      p_D.z() = rays_.column(i, j);
      if (!std::isnan(p_D.z())) visible_[static_cast<std::size_t>(owner_.of(p_D))].push_back(p_D);
    }
  }
}

bool SkinContact::place_patch(std::span<const Vec3> visible, TargetField& patch) const {
  // (C1) plane through the mean, normal to the direction of least spread, towards +z
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : visible) mean += p;
  mean /= static_cast<double>(visible.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : visible) spread += (p - mean) * (p - mean).transpose();
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
  const Pose X_PD = patch.X_DP.inverse();
  for (const Vec3& p : visible) {
    const Vec2 q = (X_PD * p).head<2>();
    lower = lower.cwiseMin(q);
    upper = upper.cwiseMax(q);
  }
  const double h = grid_.cell;
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

int SkinContact::gather(int hand, TargetField& patch) {
  // (C3) from below the lowest to above the highest visible point, along the normal
  const Vec3 normal = patch.X_DP.linear().col(2);
  double lowest = 1e9, highest = -1e9;
  for (const Vec3& p : visible_[static_cast<std::size_t>(hand)]) {
    const double z = normal.dot(p - patch.X_DP.translation());
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  lowest -= 1.5 * patch.cell;
  const double reach = highest - lowest + 0.5 * patch.cell;
  const HandShape& shape = shapes_[static_cast<std::size_t>(hand)];
  if (has_weights_) patch.weight.assign(patch.size(), 0.0);

  int skin = 0;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const Vec2 x = patch.position(row, col);
      const Vec3 start = patch.X_DP * Vec3(x.x(), x.y(), lowest);
      const double t = rays_.march(start, normal, reach);
      if (t < 0.0) continue;
      const Vec3 p_D = start + t * normal;
      if (owner_.of(p_D) != hand) continue;
      const std::size_t cell = patch.index(row, col);
      patch.skin[cell] = 1;
      patch.height[cell] = lowest + t;
      // (C4)
      patch.pressure[cell] =
          std::max(0.0, pressure_at(p_D - settings_.offset_cells * patch.cell * normal));
      if (has_weights_) patch.weight[cell] = touch_at(shape, p_D);
      ++skin;
    }
  }
  return skin;
}

/// (C5)
double SkinContact::touch_at(const HandShape& shape, const Vec3& p_D) const {
  switch (shape.region(p_D)) {
    case SkinRegion::Tip:
      return settings_.touch_tip;
    case SkinRegion::Finger:
      return settings_.touch_finger;
    case SkinRegion::Palm:
      break;
  }
  return settings_.touch_palm;
}

void SkinContact::take_pressure(const Fluid& fluid, double dt) {
  fluid_ = fluid.fluid_cells();
  pressure_ = fluid.pressure();
  if (smoothed_.empty()) return;
  const auto share = static_cast<float>(1.0 - std::exp(-dt / settings_.time_constant));
  const float* now = pressure_.data();
  const std::uint8_t* known = was_fluid_.data();
  float* smoothed = smoothed_.data();
  for (std::size_t c = 0, count = smoothed_.size(); c < count; ++c) {
    // a cell that has just become fluid has no history
    const float weight = known[c] != 0 ? share : 1.0F;
    smoothed[c] += weight * (now[c] - smoothed[c]);
  }
  std::copy(fluid_.begin(), fluid_.end(), was_fluid_.begin());
  pressure_ = smoothed_;
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
