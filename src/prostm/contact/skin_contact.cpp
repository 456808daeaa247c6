#include "prostm/contact/skin_contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr double kPalmReach = 0.05;             // ℓ of (C1) [m]
constexpr double kLeastCosine = 1e-3;           // visible skin faces the array, up to rounding
constexpr double kFadeFrom = 40 * kPi / 180.0;  // angle at which the fade (C6) begins [rad]
constexpr double kFadeTo = 62 * kPi / 180.0;    // angle at which the fade (C6) reaches 0 [rad]
// upper bound of the distance of a crossing from the skin: √3/2, the error of trilinear values, and
// a step [cells]
constexpr double kNearSkin = 1.5;

/// Returns the weight of visible skin in the fit (C1).
double plane_weight(double normal_z) {
  const double square = std::pow(std::max(normal_z, kLeastCosine), 2);
  return square * square;
}

/// Returns the slope of the palm's plane, folded: that of the palm up to 45°, then decreasing to 0
/// at 90°, where the other side of the hand starts to face the array. Continuous in the pose.
Vec2 palm_slope(const Hand& hand) {
  const Vec3& wrist = hand.position[kWrist];
  const Vec3 across =
      (hand.position[kIndexProximal] - wrist).cross(hand.position[kLittleProximal] - wrist);
  const double level = std::abs(across.z()), steep = across.head<2>().norm();
  if (level <= 0.0 || steep <= 0.0) return Vec2::Zero();
  const Vec2 downhill = (across.z() > 0.0 ? 1.0 : -1.0) / steep * across.head<2>();
  return -std::min(level / steep, steep / level) * downhill;
}

/// Returns the share of the pressure that remains on skin at an angle to the direction from the
/// array, (C6). @param cosine cosine of the angle.
double fade_of(double cosine) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::clamp((kFadeTo - angle) / (kFadeTo - kFadeFrom), 0.0, 1.0);
}

/// Returns the part with this name, or null.
const PressureSource* part_named(std::string_view name, std::span<const NamedPressure> parts) {
  const auto at = std::ranges::find(parts, name, &NamedPressure::name);
  return at == parts.end() ? nullptr : at->source;
}

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  // bounds above 0, since only one part of a hand may be visible
  v.field({"touch_palm", "", 0.001, 1000, "weight of the palm's skin"}, s.touch_palm);
  v.field({"touch_finger", "", 0.001, 1000, "weight of the fingers' skin"}, s.touch_finger);
  v.field({"touch_tip", "", 0.001, 1000, "weight of the fingertips' skin"}, s.touch_tip);
}

}  // namespace

void ContactSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void ContactSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

SkinContact::SkinContact(const ContactSettings& settings, const GridShape& grid)
    : settings_(settings),
      has_weights_(settings.touch_palm != settings.touch_finger ||
                   settings.touch_finger != settings.touch_tip),
      grid_(grid),
      anchor_(grid.p_DF),
      max_side_(2 * std::max({grid.nx, grid.ny, grid.nz})),
      rays_(grid) {
  require_bounds(settings);
  for (std::vector<SeenSkin>& skin : visible_)
    skin.reserve(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));
  queue_.reserve(max_cells());
  pressed_.reserve(max_cells());
  points_.reserve(max_cells());
  pressures_.reserve(max_cells());
}

ContactStats SkinContact::extract(const PressureSource& source, const HandRaster& raster,
                                  const HandFrame& hands, TargetFrame& out,
                                  std::span<const NamedPressure> parts) noexcept {
  ContactStats stats;
  const PressureSource *smoke = part_named("smoke", parts),
                       *movement = part_named("movement", parts);
  grid_ = raster.grid;
  shapes_.clear();
  for (const Hand& hand : hands.hands) {
    shapes_.emplace_back(hand);
    for (const Vec3& p_D : hand.position) {
      const Vec3 q = (p_D - grid_.p_DF) / grid_.cell;
      const bool inside =
          (q.array() >= 0.0).all() && q.x() <= grid_.nx && q.y() <= grid_.ny && q.z() <= grid_.nz;
      stats.joints_outside += inside ? 0 : 1;
    }
    stats.joints += static_cast<std::int64_t>(hand.position.size());
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
    if (!place_patch(visible_[hand], hands.hands[hand], patch)) continue;
    find_skin(static_cast<int>(hand), patch);
    const Cells cells = press(source, shapes_[hand], patch);
    if (smoke != nullptr && movement != nullptr) {
      press_part(*smoke, patch, patch.smoke);
      press_part(*movement, patch, patch.movement);
    }
    stats.steep_cells += cells.steep;
    if (cells.skin == 0) continue;
    fill_heights(patch, queue_);
    stats.skin_cells += cells.skin;
    stats.skin_area += cells.area;
    ++patches;
  }
  while (out.patches.size() > patches) out.patches.pop_back();
  return stats;
}

void SkinContact::find_visible() {
  for (std::vector<SeenSkin>& skin : visible_) skin.clear();
  if (shapes_.empty()) return;
  const CellBox& box = rays_.box();
  for (int j = box.lower[1]; j < box.upper[1]; ++j) {
    for (int i = box.lower[0]; i < box.upper[0]; ++i) {
      Vec3 p_D = grid_.cell_centre(i, j, 0);
      p_D.z() = rays_.column(i, j);
      if (std::isnan(p_D.z())) continue;
      visible_[static_cast<std::size_t>(owner_.of(p_D))].push_back(
          {p_D, plane_weight(rays_.inwards(p_D).z())});
    }
  }
}

/// Returns the weighted mean and the unit normal towards +z, (C1).
std::pair<Vec3, Vec3> SkinContact::fit_plane(std::span<const SeenSkin> visible,
                                             const Hand& hand) const {
  const double column = grid_.cell * grid_.cell;
  double weights = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const SeenSkin& skin : visible) {
    weights += skin.weight;
    mean += skin.weight * skin.p_D;
  }
  mean /= weights;
  const double palm = std::pow(kPalmReach, 4);
  Eigen::Matrix2d spread = palm * Eigen::Matrix2d::Identity();
  Vec2 rise = palm * palm_slope(hand);
  for (const SeenSkin& skin : visible) {
    const Vec3 d = skin.p_D - mean;
    spread += column * skin.weight * d.head<2>() * d.head<2>().transpose();
    rise += column * skin.weight * d.z() * d.head<2>();
  }
  const Vec2 slope = spread.inverse() * rise;
  return {mean, Vec3(-slope.x(), -slope.y(), 1.0).normalized()};
}

bool SkinContact::place_patch(std::span<const SeenSkin> visible, const Hand& hand,
                              TargetField& patch) const {
  const auto [mean, normal] = fit_plane(visible, hand);

  // (C2) x axis: D's x projected; origin: the foot of the anchor
  const Vec3 x = (Vec3::UnitX() - normal.x() * normal).normalized();
  patch.X_DP.linear() << x, normal.cross(x), normal;
  patch.X_DP.translation() = anchor_ + normal * normal.dot(mean - anchor_);
  patch.X_DP.makeAffine();

  // bounds of the visible skin, on multiples of the cell, with a margin for the tilt of the rays
  Vec2 lower = Vec2::Constant(1e9), upper = Vec2::Constant(-1e9);
  const Pose X_PD = patch.X_DP.inverse();
  for (const SeenSkin& skin : visible) {
    const Vec2 q = (X_PD * skin.p_D).head<2>();
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

void SkinContact::find_skin(int hand, TargetField& patch) {
  // (C3) from below the lowest to above the highest visible point, along the normal
  const Vec3 normal = patch.X_DP.linear().col(2);
  double lowest = 1e9, highest = -1e9;
  for (const SeenSkin& skin : visible_[static_cast<std::size_t>(hand)]) {
    const double z = normal.dot(skin.p_D - patch.X_DP.translation());
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  lowest -= 1.5 * patch.cell;
  const double reach = highest - lowest + 0.5 * patch.cell;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const Vec2 x = patch.position(row, col);
      const Vec3 start = patch.X_DP * Vec3(x.x(), x.y(), lowest);
      const double t = rays_.march(start, normal, reach);
      if (t < 0.0 || owner_.of(start + t * normal) != hand) continue;
      const std::size_t cell = patch.index(row, col);
      patch.skin[cell] = 1;
      patch.height[cell] = lowest + t;
    }
  }
}

SkinContact::Cells SkinContact::press(const PressureSource& source, const HandShape& shape,
                                      TargetField& patch) {
  if (has_weights_) patch.weight.assign(patch.size(), 0.0);
  pressed_.clear();
  points_.clear();
  Cells out;
  for (std::size_t cell = 0; cell < patch.size(); ++cell) {
    if (patch.skin[cell] == 0) continue;
    const Vec2 x = patch.position(cell);
    const Vec3 p_D = patch.X_DP * Vec3(x.x(), x.y(), patch.height[cell]);
    const double fade = fade_at(p_D, patch);
    if (fade <= 0.0) {
      patch.skin[cell] = 0;
      ++out.steep;
      continue;
    }
    pressed_.push_back({cell, fade});
    points_.push_back(p_D);
    if (has_weights_) patch.weight[cell] = touch_at(shape, p_D);
    ++out.skin;
    out.area += fade * patch.cell * patch.cell;
  }
  pressures_.resize(points_.size());
  source.sample(points_, -patch.X_DP.linear().col(2), pressures_);
  for (std::size_t i = 0; i < pressed_.size(); ++i)
    patch.pressure[pressed_[i].cell] = pressed_[i].fade * std::max(0.0, pressures_[i]);  // (C4)
  return out;
}

/// Samples a part of the pressure at the points of press(), with its sign.
void SkinContact::press_part(const PressureSource& part, const TargetField& patch,
                             std::vector<double>& out) {
  out.assign(patch.size(), 0.0);
  part.sample(points_, -patch.X_DP.linear().col(2), pressures_);
  for (std::size_t i = 0; i < pressed_.size(); ++i)
    out[pressed_[i].cell] = pressed_[i].fade * pressures_[i];
}

/// Returns (C6): the mean over four points a quarter of a cell away in both directions, so that the
/// sides of a finger do not appear and disappear by whole cells.
double SkinContact::fade_at(const Vec3& p_D, const TargetField& patch) const {
  double fade = 0.0;
  for (const double u : {-0.25, 0.25}) {
    for (const double v : {-0.25, 0.25}) {
      const Vec3 q = p_D + patch.X_DP.linear() * Vec3(u * patch.cell, v * patch.cell, 0.0);
      fade += 0.25 * fade_of(rays_.inwards(q).dot(q.normalized()));
    }
  }
  return fade;
}

/// Returns (C5).
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

}  // namespace prostm
