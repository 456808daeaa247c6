#pragma once
/// A model observer that distinguishes two stimuli, known from templates, by the likelihood ratio,
/// (Y2) to (Y4) of docs/design/study.md. It applies to percepts of any kind.

#include <vector>

namespace prostm {

/// The sensation that a stimulus causes, as numbers, e.g. the strength at places of the hand.
using Percept = std::vector<double>;

/// Standard deviations of an observer's internal noise.
struct ObserverNoise {
  double local = 0.0;   ///< of each number, over the mean template's largest value; > 0
  double common = 0.0;  ///< noise of a factor common to all numbers; 0 or more
};

/// Common noise of a strength: the just noticeable difference [S-7].
inline constexpr double kStrengthNoise = 0.2;

class TemplateObserver {
 public:
  /// @throws std::invalid_argument: templates that are empty, differ in size or are not finite;
  /// noise out of bounds.
  TemplateObserver(const Percept& first, const Percept& second, const ObserverNoise& noise);

  /// Distance of the templates in standard deviations of the decision variable; 0 if they are
  /// equal.
  double d_prime() const { return d_prime_; }

  /// Log-likelihood ratio of a noise-free percept, over d′: positive for the second stimulus, and
  /// ∓d′/2 at the templates. Noise adds a standard deviation of 1. @pre the percept has the size of
  /// the templates.
  double evidence(const Percept& percept) const;

 private:
  Percept middle_, weight_;
  double d_prime_ = 0.0;
};

/// Probability of a right answer of an observer that guesses in a share `lapse` of its trials.
/// @param evidence the evidence for the presented stimulus.
double chance_of_right(double evidence, double lapse);

}  // namespace prostm
