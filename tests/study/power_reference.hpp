#pragma once
/// The exact power of t tests of normal values, with which simulated power is compared.

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "prostm/study/task/statistics.hpp"

namespace prostm::test {

/// Power for an effect of size d, or d_z, by the noncentral t distribution. @param n participants
/// per group, or in total for Groups::Within; ≥ 2.
inline double t_test_power(double d, int n, Groups groups, double alpha = 0.05) {
  namespace bm = boost::math;
  const bool within = groups == Groups::Within;
  const double df = within ? n - 1.0 : 2.0 * n - 2.0;
  const double shift = std::abs(d) * std::sqrt(within ? n : 0.5 * n);
  const double bound = bm::quantile(bm::complement(bm::students_t(df), 0.5 * alpha));
  const bm::non_central_t shifted(df, shift);
  return bm::cdf(bm::complement(shifted, bound)) + bm::cdf(shifted, -bound);
}

/// The smallest number of participants with at least this power. @pre some number reaches it
inline int participants_needed(double d, Groups groups, double power = 0.8) {
  int n = 2;
  while (t_test_power(d, n, groups) < power) ++n;
  return n;
}

}  // namespace prostm::test
