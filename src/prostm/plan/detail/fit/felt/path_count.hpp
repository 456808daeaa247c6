#pragma once
/// When a live plan may change its number of paths.

#include <cstdint>
#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// Counts the regions of a target: connected cells with skin and at least kLeast of the maximum,
/// neighbours sharing an edge or a corner. Only construction allocates.
class RegionCounter {
 public:
  static constexpr double kLeast = 0.25;

  explicit RegionCounter(std::size_t max_cells);
  /// @param maximum the target's largest pressure, > 0.
  int count(const TargetField& target, double maximum);

 private:
  std::vector<std::uint8_t> open_;  // cells of a region that is not counted yet
  std::vector<std::uint32_t> next_;
};

/// The number of paths of a sequence of plans. It changes at most once a second, unless the number
/// of regions changes: at each change, focal points fade out and in.
class PathCount {
 public:
  static constexpr double kHold = 1.0;  ///< least time between two changes [s]

  void forget() { paths_ = 0; }
  /// Begins a plan. @param regions of its target.
  void begin(int regions, double time);
  /// Returns whether the number may change.
  bool may_change() const { return time_ >= held_until_; }
  /// Returns the number of paths of the last plan; 0 before the first.
  int paths() const { return paths_; }
  /// Takes the number of paths of the plan.
  void take(int paths);

 private:
  int paths_ = 0, regions_ = 0;           // of the last plan
  double time_ = 0.0, held_until_ = 0.0;  // [s]
};

}  // namespace prostm::planning
