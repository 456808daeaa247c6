#pragma once
/// Parameters of observers, fitted to the experiments of the fitted set and frozen in a file:
/// (X16) and (X17) of docs/design/psychophysics.md.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/psychophysics/prediction.hpp"

namespace prostm {

/// A parameter that is fitted, and its bounds.
struct FittedParameter {
  const char* name;  ///< also of its member in the file
  double ObserverParameters::*value;
  double low, high;  ///< over the start for `relative`
  bool logarithmic, relative;
  bool category_only;  ///< whether template observers lack it
};
std::span<const FittedParameter> fitted_parameters();
/// Whether observers with this readout have the parameter.
bool has(const FittedParameter& parameter, Readout readout);
inline constexpr std::size_t kFittedParameters = 5;

/// The range of a parameter in which the sum of the losses of all numbers is at most 1.92 above its
/// lowest, with the others fixed: 95 % where losses are log-likelihoods.
struct ParameterRange {
  double low = 0.0, high = 0.0;
  bool determined = false;  ///< whether both ends are within the bounds
};

/// An observer as fitted.
struct FittedObserver {
  PerceptModel model = PerceptModel::Peak;
  Readout readout = Readout::Template;
  ObserverParameters parameters = {};
  std::array<ParameterRange, kFittedParameters> ranges{};  ///< in the order of fitted_parameters()
  double loss = 0.0;                                       ///< (X16), of the fitted set

  Observer observer() const { return {model, readout, parameters}; }
  std::string name() const;  ///< "peak, template"
};

/// Fits one observer to experiments. @param experiments of the fitted set; at least one.
FittedObserver fit_observer(Laboratory& laboratory, PerceptModel model, Readout readout,
                            std::span<const Experiment* const> experiments);

/// Frozen observers. @throws InputError for content that is not as described in
/// docs/experiments/published.md.
std::vector<FittedObserver> parse_observers(const std::string& text, const std::string& file);
std::string observers_text(std::span<const FittedObserver> observers,
                           std::span<const Experiment* const> experiments);
/// Returns those that are compiled in, from data/psychophysics/observers.json.
const std::vector<FittedObserver>& frozen_observers();
/// SHA-256 of that file, in hexadecimal digits.
std::string_view frozen_hash();

}  // namespace prostm
