#pragma once
/// Observers: how answers follow from what is felt. Equations (X10) to (X12) of
/// docs/design/psychophysics.md.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/psychophysics/felt_stimulus.hpp"

namespace prostm {

/// How an observer reads the map of a percept.
enum class Readout : std::uint8_t {
  Template,  ///< it compares the map with those of the alternatives, which it knows
  Category,  ///< it judges one number, the depth of the dip between two places
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<Readout> = {"template", "category"};

/// Free parameters of an observer.
struct ObserverParameters {
  double threshold = 0.0;  ///< T, strength at the threshold of detection [m, or Pa]
  double noise = 1.0;      ///< κ of each place over the largest value; of a dip for Category
  double criterion = 0.0;  ///< for the answer "two", in standard deviations; a dip for Category
  double place = 7e-3;     ///< Category: standard deviation of a felt place along an axis [m]
  double strength_noise = 2.0;  ///< of a difference of two strengths [dB]
};

/// An observer with a percept model.
class Observer {
 public:
  Observer(PerceptModel model, Readout readout, const ObserverParameters& parameters)
      : model_(model), readout_(readout), parameters_(parameters) {}

  PerceptModel model() const { return model_; }
  Readout readout() const { return readout_; }
  const ObserverParameters& parameters() const { return parameters_; }

  /// Probability that a person feels the stimulus.
  double detects(const FeltStimulus& felt) const;
  /// Probability of the answer that `a` is stronger than `b`.
  double prefers(const FeltStimulus& a, const FeltStimulus& b) const;
  /// Probability of the answer "two" for two focal points. @param ends of the line between them.
  /// @param one, two stimuli that are certainly one and two, which a template observer knows.
  double says_two(const FeltStimulus& felt, const std::array<Vec2, 2>& ends,
                  const FeltStimulus& one, const FeltStimulus& two) const;
  /// Standard deviation of the felt place of a stimulus along an axis [m].
  double place_noise(const FeltStimulus& felt) const;
  /// Probability of each answer (column) to each alternative (row), by simulated answers of a
  /// template observer. @param alternatives two or more of the same patch.
  std::vector<std::vector<double>> confusions(
      std::span<const FeltStimulus* const> alternatives) const;
  /// Probability that a category observer counts points right. @param points of the stimulus.
  double counts(const FeltStimulus& felt, const std::vector<Vec2>& points) const;
  /// Probability of a right answer on the direction of a sweep.
  double tells_direction(const FeltStimulus& felt) const;
  /// Just noticeable relative difference of curvature, from the courses of two arcs. @param point
  /// one focal point at rest. @param curvatures of the arcs [1/m].
  double curvature_weber(const FeltStimulus& point, const FeltStimulus& reference,
                         const FeltStimulus& other, const std::array<double, 2>& curvatures) const;

 private:
  double local_noise(const FeltStimulus& felt) const;

  PerceptModel model_;
  Readout readout_;
  ObserverParameters parameters_;
};

/// Returns 20 log10 of a ratio of strengths [dB]; ±300 dB where one of them is 0.
double decibels(double strength, double reference);

/// Returns the depth of the lowest dip of a map between two places, 0..1: one minus the lowest
/// value between them over the lower of both.
double dip_between(const FeltStimulus& felt, const Vec2& a, const Vec2& b);

/// Returns the deepest dip between the strongest places of neighbouring quadrants about a map's
/// centroid: near 0 for one lump, near 1 for four. 0 for a map of zeros.
double deepest_dip(const FeltStimulus& felt);

}  // namespace prostm
