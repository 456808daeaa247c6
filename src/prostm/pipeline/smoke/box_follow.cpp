#include "prostm/pipeline/smoke/box_follow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({.name = "follow", .help = "point that the smoke's box follows"}, s.follow);
}

}  // namespace

void BoxSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void BoxSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

CellShift BoxFollower::shift(const HandFrame& hands, const GridShape& now) const noexcept {
  constexpr double kReach = 10.0;  // hands farther from the array are ignored [m]
  const double edge = now.cell * now.nx;
  Vec3 wanted = home_.p_DF;
  double slack = 0.0;  // a box that follows nothing returns exactly to its home
  if (settings_.follow != BoxFollows::Nothing) {
    const Vec3 middle = edge * Vec3(0.5, 0.5, 2.0 / 3.0);
    const auto joint = settings_.follow == BoxFollows::Palm ? kPalm : kIndexTip;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Hand& hand : hands.hands) {
      const Vec3& p = hand.position[joint];
      // not by allFinite(), which traps
      if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z())) continue;
      const Vec3 corner = p.cwiseMax(-kReach).cwiseMin(kReach) - middle;
      const double away = (corner - now.p_DF).norm();
      if (away >= nearest) continue;
      nearest = away;
      wanted = corner;
    }
    if (std::isinf(nearest)) return {};
    wanted.z() = std::clamp(wanted.z(), home_.p_DF.z(), home_.p_DF.z() + kHighestFloor);
    slack = kSlack * edge;
  }
  const Vec3 off = wanted - now.p_DF;
  if ((off.array().abs() <= slack).all()) return {};
  return whole_cells(off, now.cell);
}

}  // namespace prostm
