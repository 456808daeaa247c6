#pragma once
/// GS-PAT as a good plain program implements it: the baseline of the live solvers.

#include <span>
#include <vector>

#include "prostm/acoustics/array/array.hpp"

namespace prostm::bench {

/// (A13) in single precision, with real and imaginary parts apart so that the compiler vectorises
/// all loops over transducers; compiled with -O3 -ffast-math for the machine it is built on.
class TextbookGsPat {
 public:
  /// @pre a flat array in z = 0 that faces +z, of pistons.
  TextbookGsPat(const TransducerArray& array, const Medium& medium, int most_foci);

  /// Computes drives for `foci` [m]; `a` are the target pressures relative to each focus alone. One
  /// common factor keeps every drive at or below 1.
  void solve(std::span<const Eigen::Vector3f> foci, std::span<const float> a, int iterations);

  std::span<const float> re() const { return q_re_; }
  std::span<const float> im() const { return q_im_; }

 private:
  void propagate(const Eigen::Vector3f& p, float* re, float* im) const;
  void correlate(std::size_t foci);
  void iterate(std::size_t foci, int iterations);

  std::size_t n_;
  float wave_number_, absorption_, radius_, amplitude_;
  std::vector<float> x_, y_;
  std::vector<float> g_re_, g_im_, r_re_, r_im_;  // M × N, M × M
  std::vector<float> p_re_, p_im_, t_re_, t_im_, a_, squares_, q_re_, q_im_;
};

}  // namespace prostm::bench
