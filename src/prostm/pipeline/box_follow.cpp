#include "prostm/pipeline/box_follow.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({.name = "follow", .help = "what the smoke's box follows"}, s.follow);
}

}  // namespace

void BoxSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void BoxSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

CellShift BoxFollower::shift(const HandFrame& hands, const GridShape& now) const noexcept {
  constexpr double kReach = 10.0;  // nobody's hand is farther from the array [m]
  const double edge = now.cell * now.nx;
  Vec3 wanted = home_.p_DF;
  double slack = 0.0;  // a box that follows nothing goes home
  if (settings_.follow != BoxFollows::Nothing) {
    if (hands.hands.empty()) return {};
    const Vec3 point =
        hands.hands.front().position[settings_.follow == BoxFollows::Palm ? kPalm : kIndexTip];
    // not by allFinite(), which traps
    if (!std::isfinite(point.x()) || !std::isfinite(point.y()) || !std::isfinite(point.z()))
      return {};
    wanted = point.cwiseMax(-kReach).cwiseMin(kReach) - edge * Vec3(0.5, 0.5, 2.0 / 3.0);
    wanted.z() = std::clamp(wanted.z(), home_.p_DF.z(), home_.p_DF.z() + kHighestFloor);
    slack = kSlack * edge;
  }
  const Vec3 off = wanted - now.p_DF;
  if ((off.array().abs() <= slack).all()) return {};
  CellShift cells;
  for (int a = 0; a < 3; ++a)
    cells[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(off[a] / now.cell));
  return cells;
}

}  // namespace prostm
