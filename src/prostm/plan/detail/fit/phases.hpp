#pragma once
/// Where focal points begin their loops, and which way round they go, so that they stay apart while
/// they run. All lengths in mm.

#include <array>
#include <boost/container/static_vector.hpp>
#include <span>

#include "prostm/plan/detail/fit/loops.hpp"

namespace prostm::planning {

/// A loop run counterclockwise from its sample 0, at equal arcs: where a focal point is at equal
/// times.
struct EvenLap {
  static constexpr int kMostArcs = 32;

  /// Loop `path` of `loops`, at min(samples, kMostArcs) arcs.
  void set(const Loops& loops, int path);
  /// The arc that is nearest to a sample, along the loop.
  int nearest_arc(int sample) const;
  /// The sample that is nearest to an arc, along the loop.
  int nearest_sample(int arc) const;

  int samples = 0, arcs = 0;
  bool reversed = false;  ///< against the order of the samples
  std::array<float, static_cast<std::size_t>(2 * kMostArcs)> x, y;  ///< of each arc, twice round
  std::array<double, kMaxPathPoints> passed;                        ///< at each sample, in arcs
};

/// What (P16) sums over the pairs of up to kMaxPaths focal points.
class PhaseCosts {
 public:
  /// Takes the loops. @param periods of a lap on each [s], > 0.
  void set(std::span<const EvenLap> laps, std::span<const double> periods);

  /// The sum of (P16). @param arc that each focal point starts from, 0..arcs − 1.
  float total(std::span<const int> arc) const;
  /// Lowers the total, one focal point at a time, until that lowers it no more.
  /// @param free whether a focal point may be moved.
  void descend(std::span<int> arc, std::span<const bool> free) const;
  /// The arcs of the least total that descents from several places find.
  void search(std::span<int> arc) const;

 private:
  static constexpr std::size_t kRow = 2 * static_cast<std::size_t>(EvenLap::kMostArcs);
  using Row = std::array<float, kRow>;

  void add_pair(const EvenLap& a, const EvenLap& b, double gained, Row& ahead, Row& behind) const;
  Row& row(std::size_t k, std::size_t j) { return rows_[k * kMaxPaths + j]; }
  const Row& row(std::size_t k, std::size_t j) const { return rows_[k * kMaxPaths + j]; }

  std::size_t paths_ = 0;
  int arcs_ = 0;
  /// Cost of focal point k when it starts from arc a and j from arc b, at [k, j][arcs + a − b].
  std::array<Row, static_cast<std::size_t>(kMaxPaths* kMaxPaths)> rows_;
};

/// How a focal point runs a loop: from sample `first` on, against their order if `reversed`.
struct LapStart {
  int first = 0;
  bool reversed = false;

  /// The i-th sample on its way. @pre 0 <= i < samples.
  int sample(int i, int samples) const { return (first + (reversed ? samples - i : i)) % samples; }
};
using LapStarts = boost::container::static_vector<LapStart, kMaxPaths>;

/// Chooses how the loops of one plan after the other are run. Allocates and throws nothing.
class Phases {
 public:
  /// Forgets where the last plan's loops began.
  void forget() { before_.clear(); }
  /// Brings where they began to other coordinates.
  void move(const Vec2& shift) {
    for (Vec2& x : before_) x += shift;
  }
  /// All loops counterclockwise, begun at samples that make the distance of (P16) large. Loops near
  /// which one of the last plan's began go on beginning there, unless others gain 10 %.
  /// @param periods of a lap on each [s], > 0.
  LapStarts choose(const Loops& loops, std::span<const double> periods);

 private:
  std::span<const EvenLap> laps(int paths) const {
    return std::span<const EvenLap>(laps_).first(static_cast<std::size_t>(paths));
  }
  bool find_kept(const Loops& loops, std::span<int> arc, std::span<bool> is_new) const;

  std::array<EvenLap, kMaxPaths> laps_;
  PhaseCosts costs_;
  boost::container::static_vector<Vec2, kMaxPaths> before_;  // where the last plan's loops began
};

}  // namespace prostm::planning
