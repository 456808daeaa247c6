#pragma once
/// The output that a plan in step demands of an array over its loop: (P20).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/felt/step_path.hpp"
#include "prostm/plan/detail/fit/felt/envelope.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm::planning {

/// The pressures of all paths together at moments of a loop. Sized once; nothing else allocates.
class Demand {
 public:
  Demand();

  /// Takes over paths of `samples` points each.
  void set(std::span<const StepPath<float>> paths, std::size_t samples);
  /// Divides pressures by the output that they take. @param pressure of the points, one path after
  /// the other; not all 0. @return the output.
  float normalise(std::span<float> pressure);
  /// Makes the gradient of a cost of the last normalised pressures one with respect to pressures
  /// that are yet to be normalised, times their output. @param along Σ gradient · pressure.
  void add_gradient(float along, std::span<float> gradient) const;
  /// Adds the gradient of the same with respect to time() of the points. @param pressure
  /// as it was normalised.
  void add_by_time(float along, std::span<const float> pressure, std::span<float> by_time) const;

  /// Returns the cost (P24) of focal points that are near each other at one moment, and adds its
  /// gradient with respect to the points [1/mm], and to time() of them.
  float near_cost(const StepPoints& points, std::span<float> gradient_x,
                  std::span<float> gradient_y, std::span<float> by_time) const;

 private:
  static constexpr std::size_t kMoments = 160;  // of a loop: a few for each point

  /// A path at a moment: on its way from one point to the next.
  struct Passing {
    std::uint16_t moment = 0, first = 0, second = 0;
    bool ends_lap = false;  // `second` is the path's first point
    float share = 0.0F;     // of the way
    float duration = 1.0F;  // of the way, as a share of a lap
  };
  void pass(const StepPath<float>& path, std::size_t begin, std::size_t samples);
  /// Adds what follows from the gradient with respect to where a path is.
  void add_place(const Passing& at, const StepPoints& points, float dx, float dy,
                 std::span<float> gradient_x, std::span<float> gradient_y,
                 std::span<float> by_time) const;

  std::vector<Passing> passings_;
  std::array<float, kMoments> by_demand_{};  // derivative of the output by that of each moment
};

}  // namespace prostm::planning
