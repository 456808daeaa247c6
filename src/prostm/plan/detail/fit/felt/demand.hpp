#pragma once
/// The array output that a plan in step demands over its loop: (P20).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/felt/step_path.hpp"
#include "prostm/plan/detail/fit/felt/envelope.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm::planning {

/// Sum of the pressures of all paths at each moment of a loop. Only construction allocates.
class Demand {
 public:
  Demand();

  /// Sets the paths, of `samples` points each.
  void set(std::span<const StepPath<float>> paths, std::size_t samples);
  /// Divides pressures by the output that they demand. @param pressure pressures of the points, one
  /// path after the other; not all 0. @return the output.
  float normalise(std::span<float> pressure);
  /// Converts a cost's gradient with respect to the normalised pressures of the last call into the
  /// gradient with respect to the original ones, times their output. @param along Σ gradient ·
  /// pressure.
  void add_gradient(float along, std::span<float> gradient) const;
  /// Adds the gradient of that cost with respect to time() of the points. @param pressure
  /// normalised pressures.
  void add_by_time(float along, std::span<const float> pressure, std::span<float> by_time) const;

  /// Returns the cost (P24) of focal points that are near each other at the same moment, and adds
  /// its gradient with respect to the points [1/mm] and to their time().
  float near_cost(const StepPoints& points, std::span<float> gradient_x,
                  std::span<float> gradient_y, std::span<float> by_time) const;

 private:
  static constexpr std::size_t kMoments = 160;  // moments per loop: a few for each point

  /// State of a path at a moment: between which two points its focal point is, and where.
  struct Passing {
    std::uint16_t moment = 0, first = 0, second = 0;
    bool ends_lap = false;  // `second` is the path's first point
    float share = 0.0F;     // covered share of the segment
    float duration = 1.0F;  // duration of the segment, as a share of a lap
  };
  void pass(const StepPath<float>& path, std::size_t begin, std::size_t samples);
  /// Adds to the gradients, given the gradient (dx, dy) with respect to the focal point's position.
  void add_place(const Passing& at, const StepPoints& points, float dx, float dy,
                 std::span<float> gradient_x, std::span<float> gradient_y,
                 std::span<float> by_time) const;

  std::vector<Passing> passings_;
  std::array<float, kMoments> by_demand_{};  // ∂output/∂(demand at each moment)
};

}  // namespace prostm::planning
