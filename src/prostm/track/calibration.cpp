#include "prostm/track/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/core/text/number_text.hpp"

namespace prostm {
namespace {

constexpr double kLeastSpread = 0.010;  // least rms distance of the points from a line [m]

struct Means {
  Vec3 p_T = Vec3::Zero(), p_D = Vec3::Zero();
};

Means means_of(std::span<const PointPair> points) {
  Means means;
  for (const PointPair& pair : points) {
    if (!pair.p_T.allFinite() || !pair.p_D.allFinite())
      throw std::invalid_argument(
          "a calibration point is not finite; points must be positions in metres");
    means.p_T += pair.p_T;
    means.p_D += pair.p_D;
  }
  means.p_T /= static_cast<double>(points.size());
  means.p_D /= static_cast<double>(points.size());
  return means;
}

/// Rms distance of the points from the line that fits them best; the smaller of both frames' [m].
double spread_beside_line(std::span<const PointPair> points, const Means& means) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Zero(), D = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : points) {
    const Vec3 a = pair.p_T - means.p_T, b = pair.p_D - means.p_D;
    T += a * a.transpose();
    D += b * b.transpose();
  }
  const auto beside = [&](const Eigen::Matrix3d& covariance) {
    const Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
    return std::sqrt(std::max(s[1] + s[2], 0.0) / static_cast<double>(points.size()));
  };
  return std::min(beside(T), beside(D));
}

/// Returns the pose with the orthogonal matrix R: its translation and its residuals.
Calibration with(const Eigen::Matrix3d& R, std::span<const PointPair> points, const Means& means) {
  Calibration found;
  found.X_DT.linear() = R;
  found.X_DT.translation() = means.p_D - R * means.p_T;
  double squares = 0.0;
  for (const PointPair& pair : points) {
    const double left = (pair.p_D - (R * pair.p_T + found.X_DT.translation())).norm();
    squares += left * left;
    found.largest = std::max(found.largest, left);
  }
  found.rms = std::sqrt(squares / static_cast<double>(points.size()));
  return found;
}

}  // namespace

Calibration calibrate(std::span<const PointPair> points) {
  if (points.size() < 3) {
    const bool one = points.size() == 1;
    throw std::invalid_argument(
        fmt::format("there {} {} calibration point{}; a pose needs at least 3 that are not on one "
                    "line",
                    one ? "is" : "are", points.size(), one ? "" : "s"));
  }
  const Means means = means_of(points);
  if (const double spread = spread_beside_line(points, means); !(spread >= kLeastSpread)) {
    const ComparedText text = compared_text(1e3 * spread, 1e3 * kLeastSpread, 1);
    throw std::invalid_argument(
        fmt::format("the calibration points are within {} mm rms of one line; it must be at least "
                    "{} mm",
                    text.value, text.bound));
  }

  // (H20): the rotation nearest to the points' cross-covariance
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : points)
    covariance += (pair.p_D - means.p_D) * (pair.p_T - means.p_T).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Matrix3d U = svd.matrixU();
  if (nearest.determinant() < 0.0) U.col(2) *= -1.0;
  const Calibration found = with(U * svd.matrixV().transpose(), points, means);
  const double mirrored = with(nearest, points, means).rms;
  if (nearest.determinant() < 0.0 && found.rms > 2.0 * mirrored + 0.002) {
    throw std::invalid_argument(fmt::format(
        "the calibration points fit a mirror image ({:.1f} mm rms) but no rotation ({:.1f} mm); an "
        "axis is reversed or two points are exchanged",
        mirrored * 1e3, found.rms * 1e3));
  }
  return found;
}

}  // namespace prostm
