#pragma once
/// Power of a planned study, by simulating its design.

#include <cstdint>
#include <optional>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// Shares of right answers that a study assumes (Y11).
struct AssumedShares {
  double first = 0.5, second = 0.5;  ///< mean shares of the methods, 0..1
  int trials = 16;                   ///< trials of each participant with each method
  /// ρ of two answers of a person with a method: shares of people have a beta distribution with the
  /// variance ρ p (1 − p).
  double correlation = 0.1;
  /// Correlation of a person's shares with the two methods, for Groups::Within, as normal scores
  double alike = 0.5;
};

/// A planned comparison of two methods by the t test over participants: Welch's, or paired.
struct StudyDesign {
  Groups groups = Groups::Between;
  double alpha = 0.05;
  AssumedShares shares;     ///< read unless `d` is set
  std::optional<double> d;  ///< effect size, d or d_z: scores are then normal, without trials
};
/// @throws std::invalid_argument: alpha not in 0.0001 to 0.5, shares not in 0.01 to 0.99, trials
/// not in 1 to 1000, correlation not in 0.001 to 0.9, alike not in 0 to 0.99, d not in 0.01 to 10.
void validate(const StudyDesign& design);

/// Studies of a design. Each is simulated with 2, 3, … participants: a larger study has the
/// participants of the smaller one and more. So power hardly ever falls with their number.
class SimulatedStudies {
 public:
  /// @param studies number of them. @pre the design is valid, studies > 0.
  SimulatedStudies(const StudyDesign& design, int studies, std::uint64_t seed);
  ~SimulatedStudies();

  /// Returns the significant ones of studies with n participants, per group or in total for
  /// Groups::Within. @pre n ≥ 2.
  Proportion power(int n);
  /// Returns the smallest number of participants from which on power is at least this; nothing
  /// above `most`. @pre 0 < power < 1.
  std::optional<int> needed(double power, int most = 2000);

 private:
  class Study;
  void reach(int n);

  StudyDesign design_;
  std::vector<Study> studies_;
  std::vector<double> quantiles_[2];  // of each method's shares, over normal scores
  std::vector<int> significant_;      // studies, by number of participants
};

}  // namespace prostm
