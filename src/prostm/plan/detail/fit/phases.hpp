#pragma once
/// Starts and directions of the focal points' laps, chosen so that the focal points stay apart.
/// All lengths in mm.

#include <array>
#include <boost/container/static_vector.hpp>
#include <span>

#include "prostm/plan/detail/fit/loops.hpp"

namespace prostm::planning {

/// A loop traversed counterclockwise from its sample 0, resampled at equal arcs: the positions of a
/// focal point at equal time steps.
struct EvenLap {
  static constexpr int kMostArcs = 32;

  /// Resamples loop `path` of `loops` at min(samples, kMostArcs) arcs.
  void set(const Loops& loops, int path);
  /// Returns the arc that is nearest to a sample, along the loop.
  int nearest_arc(int sample) const;
  /// Returns the sample that is nearest to an arc, along the loop.
  int nearest_sample(int arc) const;

  int samples = 0, arcs = 0;
  bool reversed = false;  ///< whether it traverses the samples in descending order
  /// Position of each arc, for two laps.
  std::array<float, static_cast<std::size_t>(2 * kMostArcs)> x, y;
  std::array<double, kMaxPathPoints> passed;  ///< arcs passed at each sample
};

/// The terms of (P16) for the pairs of up to kMaxPaths focal points.
class PhaseCosts {
 public:
  /// Sets the loops. @param periods duration of a lap of each [s], > 0.
  void set(std::span<const EvenLap> laps, std::span<const double> periods);

  /// Returns the sum of (P16). @param arc start arc of each focal point, 0..arcs − 1.
  float total(std::span<const int> arc) const;
  /// Moves one focal point at a time as long as that lowers the total.
  /// @param free whether a focal point may be moved.
  void descend(std::span<int> arc, std::span<const bool> free) const;
  /// Finds the arcs with the least total by descents from several starts.
  void search(std::span<int> arc) const;

 private:
  static constexpr std::size_t kRow = 2 * static_cast<std::size_t>(EvenLap::kMostArcs);
  using Row = std::array<float, kRow>;

  void add_pair(const EvenLap& a, const EvenLap& b, double gained, Row& ahead, Row& behind) const;
  Row& row(std::size_t k, std::size_t j) { return rows_[k * kMaxPaths + j]; }
  const Row& row(std::size_t k, std::size_t j) const { return rows_[k * kMaxPaths + j]; }

  std::size_t paths_ = 0;
  int arcs_ = 0;
  /// Cost of focal points k, starting from arc a, and j, starting from arc b: at [k, j][arcs + a −
  /// b].
  std::array<Row, static_cast<std::size_t>(kMaxPaths* kMaxPaths)> rows_;
};

/// Start and direction of a lap: from sample `first` on, in descending order of samples if
/// `reversed`.
struct LapStart {
  int first = 0;
  bool reversed = false;

  /// Index of the i-th sample of the lap. @pre 0 <= i < samples.
  int sample(int i, int samples) const { return (first + (reversed ? samples - i : i)) % samples; }
};
using LapStarts = boost::container::static_vector<LapStart, kMaxPaths>;

/// Chooses the starts and directions of laps for one plan after another. Allocates and throws
/// nothing.
class Phases {
 public:
  /// Forgets the starts of the last plan.
  void forget() { before_.clear(); }
  /// Shifts the coordinates of these starts.
  void move(const Vec2& shift) {
    for (Vec2& x : before_) x += shift;
  }
  /// Chooses counterclockwise laps whose starts make the distance D of (P16) large. Loops near a
  /// start of the last plan keep it, unless other starts gain 10 %.
  /// @param periods duration of a lap of each loop [s], > 0.
  LapStarts choose(const Loops& loops, std::span<const double> periods);

 private:
  std::span<const EvenLap> laps(int paths) const {
    return std::span<const EvenLap>(laps_).first(static_cast<std::size_t>(paths));
  }
  bool find_kept(const Loops& loops, std::span<int> arc, std::span<bool> is_new) const;

  std::array<EvenLap, kMaxPaths> laps_;
  PhaseCosts costs_;
  boost::container::static_vector<Vec2, kMaxPaths> before_;  // starts of the last plan
};

}  // namespace prostm::planning
