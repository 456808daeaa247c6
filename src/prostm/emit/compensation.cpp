#include "prostm/emit/compensation.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/target/skin_normal.hpp"

namespace prostm {
namespace {

/// The cell that holds a point of the plane, or the nearest one.
int nearest_cell(double x, double origin, double cell, int count) {
  const double place = std::clamp((x - origin) / cell, 0.0, static_cast<double>(count - 1));
  return static_cast<int>(std::lround(place));
}

}  // namespace

double tilt_factor(const Vec3& p_D, const Vec3& normal_D, double bound) {
  const double cosine = std::max(-p_D.normalized().dot(normal_D), 0.0);
  return cosine * cosine * bound > 1.0 ? 1.0 / (cosine * cosine) : bound;
}

void compensate_tilt(LiftedPlan& plan, const TargetFrame& frame, double bound) noexcept {
  if (bound <= 1.0) return;
  const auto factor = [&](const Vec3& p_D, int patch) {
    const TargetField& field = frame.patches[static_cast<std::size_t>(patch)];
    const Vec3 p = field.X_DP.inverse(Eigen::Isometry) * p_D;
    const Vec3 normal =
        skin_normal(field, nearest_cell(p.y(), field.origin.y(), field.cell, field.rows),
                    nearest_cell(p.x(), field.origin.x(), field.cell, field.cols));
    return tilt_factor(p_D, field.X_DP.linear() * normal, bound);
  };
  for (LiftedPath& path : plan.paths) {
    for (std::size_t i = 0; i < path.p_D.size(); ++i) {
      path.pressure[i] *= factor(path.p_D[i], path.patch);
    }
  }
  for (LiftedFocus& focus : plan.foci) focus.pressure *= factor(focus.p_D, focus.patch);
}

}  // namespace prostm
