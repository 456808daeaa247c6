#pragma once
/// Points and transforms of the stand-in. Lengths are in metres.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

namespace Ultraleap::Haptics {

using LocalDuration = std::chrono::duration<std::int64_t, std::nano>;
using LocalTimeClock = std::chrono::steady_clock;
using LocalTimePoint = std::chrono::time_point<LocalTimeClock, LocalDuration>;

struct Vector3 {
  Vector3() = default;
  Vector3(float a, float b, float c) : x(a), y(b), z(c) {}
  float x = 0.0F, y = 0.0F, z = 0.0F;
};

/// Rows of a 4 × 4 matrix; the origin is the last column.
struct Transform {
  float element[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  static Transform translation(float x, float y, float z) {
    Transform out;
    out.element[3] = x;
    out.element[7] = y;
    out.element[11] = z;
    return out;
  }
};

/// A focal point of the array. It keeps its values between samples.
class ControlPoint {
 public:
  Vector3 getPosition() const { return position_; }
  void setPosition(Vector3 position) { position_ = position; }
  float getIntensity() const { return intensity_; }
  void setIntensity(float intensity) { intensity_ = std::fmin(std::fmax(0.0F, intensity), 1.0F); }
  std::uint8_t getGroup() const { return group_; }
  void setGroup(std::uint8_t group) { group_ = group; }

 private:
  Vector3 position_;
  float intensity_ = 0.0F;
  std::uint8_t group_ = 0;
};

struct Transducer {
  Vector3 position;
};
using TransducerContainer = std::vector<Transducer>;

}  // namespace Ultraleap::Haptics
