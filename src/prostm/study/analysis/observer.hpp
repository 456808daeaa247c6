#pragma once
/// A model observer that knows two stimuli by templates and tells them apart by the likelihood
/// ratio, (Y2) to (Y4) of docs/design/study.md. It is arithmetic on percepts, whatever they are of.

#include <vector>

namespace prostm {

/// Numbers that a stimulus makes an observer feel, e.g. the strength at places of the hand.
using Percept = std::vector<double>;

/// Standard deviations of an observer's internal noise.
struct ObserverNoise {
  double local = 0.0;   ///< of each number, over the largest of the templates' mean; > 0
  double common = 0.0;  ///< of a factor that all numbers share; 0 or more
};

class TemplateObserver {
 public:
  /// @throws std::invalid_argument: templates that are empty, differ in size, or hold a number that
  /// is not finite; noise that is out of its bounds.
  TemplateObserver(const Percept& first, const Percept& second, const ObserverNoise& noise);

  /// Distance of the templates in standard deviations of what tells them apart. 0 where they are
  /// the same.
  double d_prime() const { return d_prime_; }

  /// Logarithm of the likelihood ratio of a percept before its noise, over d′: above 0 it speaks
  /// for the second stimulus. With the noise it varies with a standard deviation of 1. ∓d′/2 at the
  /// templates. @pre as many numbers as the templates.
  double evidence(const Percept& percept) const;

 private:
  Percept middle_, weight_;
  double d_prime_ = 0.0;
};

/// Chance of a right answer of an observer that guesses in a share `lapse` of its trials.
/// @param evidence for the stimulus that is there.
double chance_of_right(double evidence, double lapse);

}  // namespace prostm
