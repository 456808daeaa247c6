#include "prostm/fields/skin_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm::fields {
namespace {

constexpr double kPalmRadius = 60e-3, kPalmReach = 50e-3;
constexpr double kKnuckleRadius = 9e-3;
constexpr int kKnuckles = 4;
constexpr double kCurlRadius = 25e-3, kCurlSlope = kPi / 3.0;

double palm_height(const Vec2& x) {
  const auto height = [](double r) { return std::sqrt(kPalmRadius * kPalmRadius - r * r); };
  return height(std::min(x.norm(), kPalmReach)) - height(kPalmReach);
}

double fist_height(const Vec2& x) {
  constexpr double kWidth = 2.0 * kKnuckleRadius;
  if (std::abs(x.x()) >= 0.5 * kKnuckles * kWidth) return 0.0;
  // offset from the axis of the nearest of an even number of cylinders
  const double offset = x.x() - kWidth * (std::floor(x.x() / kWidth) + 0.5);
  return -std::sqrt(std::max(kKnuckleRadius * kKnuckleRadius - offset * offset, 0.0));
}

double curl_height(const Vec2& x) {
  const double y = std::abs(x.y()), bent = kCurlRadius * std::sin(kCurlSlope);
  const double on = std::min(y, bent);
  return kCurlRadius - std::sqrt(kCurlRadius * kCurlRadius - on * on) +
         std::tan(kCurlSlope) * (y - on);
}

}  // namespace

std::string to_string(SkinShape shape) {
  switch (shape) {
    case SkinShape::CuppedPalm:
      return "cupped palm";
    case SkinShape::Fist:
      return "fist";
    case SkinShape::CurledHand:
      break;
  }
  return "curled hand";
}

double skin_height(SkinShape shape, const Vec2& x) {
  switch (shape) {
    case SkinShape::CuppedPalm:
      return palm_height(x);
    case SkinShape::Fist:
      return fist_height(x);
    case SkinShape::CurledHand:
      break;
  }
  return curl_height(x);
}

TargetField with_skin(TargetField field, SkinShape shape, bool in_voxels) {
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      double height = skin_height(shape, field.position(row, col));
      if (in_voxels) height = kVoxel * std::round(height / kVoxel);
      field.height[field.index(row, col)] = height;
    }
  }
  return field;
}

}  // namespace prostm::fields
