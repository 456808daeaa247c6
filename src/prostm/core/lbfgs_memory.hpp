#pragma once
/// The memory of L-BFGS [P-5]: the last steps of a descent, and the resulting direction.

#include <algorithm>
#include <array>
#include <cstddef>

namespace prostm {

/// Allocates only within its vectors.
///
/// Operations on vectors are given by an object with
///   float dot(const Vector& a, const Vector& b)
///   void add(Vector& v, float factor, const Vector& w)  v + factor · w
///   void scale(Vector& v, float factor)
///   void precondition(Vector& v)                        an inverse Hessian, up to a factor
template <class Vector, std::size_t kSteps>
class LbfgsMemory {
 public:
  LbfgsMemory() = default;
  /// @param zero initial value of every vector.
  explicit LbfgsMemory(const Vector& zero) {
    step_.fill(zero);
    change_.fill(zero);
  }

  bool is_empty() const { return remembered_ == 0; }
  void forget() {
    remembered_ = spare_ = 0;
    scale_ = 1.0F;
  }

  /// Slots for the next step and the change of the gradient over it, to be filled before keep().
  Vector& step() { return step_[spare_]; }
  Vector& change() { return change_[spare_]; }
  /// Keeps the filled slots, discarding the oldest step if full. @param curvature step · change, >
  /// 0.
  /// @param scale factor of the preconditioner: step · change over change · (preconditioned
  /// change).
  void keep(float curvature, float scale) {
    inverse_curvature_[spare_] = 1.0F / curvature;
    scale_ = scale;
    const std::size_t taken = spare_;
    if (remembered_ == kSteps) {
      spare_ = order_[0];
      std::rotate(order_.begin(), order_.begin() + 1, order_.end());
    } else {
      spare_ = ++remembered_;
    }
    order_[remembered_ - 1] = taken;
  }

  /// Turns the negative gradient into the direction, by the two-loop recursion.
  template <class Operations>
  void find_direction(const Operations& operations, Vector& direction) const {
    std::array<float, kSteps + 1> along{};  // by slot
    for (std::size_t m = remembered_; m-- > 0;) {
      const std::size_t k = order_[m];
      along[k] = inverse_curvature_[k] * operations.dot(step_[k], direction);
      operations.add(direction, -along[k], change_[k]);
    }
    operations.precondition(direction);
    operations.scale(direction, scale_);
    for (std::size_t m = 0; m < remembered_; ++m) {
      const std::size_t k = order_[m];
      const float against = inverse_curvature_[k] * operations.dot(change_[k], direction);
      operations.add(direction, along[k] - against, step_[k]);
    }
  }

 private:
  std::array<Vector, kSteps + 1> step_, change_;
  std::array<float, kSteps + 1> inverse_curvature_{};
  std::array<std::size_t, kSteps> order_{};  // slots, the oldest step first
  std::size_t remembered_ = 0, spare_ = 0;
  float scale_ = 1.0F;
};

}  // namespace prostm
