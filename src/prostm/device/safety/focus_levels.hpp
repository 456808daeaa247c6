#pragma once
/// The highest level that an array can reach at a point: a look-up table for real time.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// Largest amplitude of an array's transducers according to the sources [Pa·m].
double largest_amplitude(const TransducerArray& array);
/// Smallest amplitude according to the sources, the measurement of this array included [Pa·m].
double smallest_amplitude(const TransducerArray& array);
/// The amplitude that was measured with the array, else its nominal amplitude [Pa·m].
double likely_amplitude(const TransducerArray& array);

/// Acoustic pressure (rms) at p of one focal point there at full drive, with air's absorption [Pa].
/// @param amplitude of the transducers [Pa·m].
double absorbed_pressure(const TransducerArray& array, const Vec3& p, double amplitude);

/// Acoustic pressure (rms) at p if every transducer is driven fully and all contributions arrive in
/// phase, Σ A·D(θ)/r [Pa], with A the largest amplitude and no absorption: an upper bound for any
/// drives. Distances under 10 mm count as 10 mm.
double full_pressure(const TransducerArray& array, const Vec3& p);

/// full_pressure() on a grid around the array, from 20 mm above it to 520 mm and 120 mm to its
/// sides. Values between the nodes are interpolated, and raised according to the curvature: they
/// are never below the exact value, and in the middle of the grid at most some percent above it.
class FocusLevels {
 public:
  /// Takes some milliseconds. @throws std::invalid_argument as validate(array) does.
  explicit FocusLevels(const TransducerArray& array);

  /// Whether this position is within the table. @pre p is finite.
  bool holds(const Eigen::Vector3f& p) const noexcept;
  /// Upper bound of the acoustic pressure (rms) there at full drive [Pa]. @pre holds(p)
  float pressure(const Eigen::Vector3f& p) const noexcept;
  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  float& node(int x, int y, int z) {
    return node_[static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x)];
  }
  void raise();

  Eigen::AlignedBox3d box_;
  double spacing_ = 0.0;  // [m]
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  Eigen::Vector3f corner_ = Eigen::Vector3f::Zero(), most_ = Eigen::Vector3f::Zero();
  float per_metre_ = 0.0F;   // nodes
  std::vector<float> node_;  // x fastest [Pa]
};

}  // namespace prostm
