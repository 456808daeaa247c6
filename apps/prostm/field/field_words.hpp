#pragma once
/// Messages about fields, plans, and how strongly they are felt.

#include <cstdio>
#include <string>
#include <vector>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Returns one line about a field as it was read: size, cells, skin, largest pressure and its unit.
std::string field_in_words(const std::string& path, FieldKind kind, const TargetField& field,
                           const FieldFileOptions& options);

/// Returns a warning for each sign that the field is not what its author intended.
std::vector<std::string> field_warnings(FieldKind kind, const TargetField& field,
                                        const FieldFileOptions& options);

/// Prints a verdict on a plan for people who do not know the metrics. @param played metrics of the
/// plan as it is played. @param unfelt why its percept was not computed, if it was not.
void print_verdict(std::FILE* out, const TargetField& field, const Plan& plan,
                   const Metrics& played, const SensationInterval& interval,
                   const std::string& unfelt);

/// Returns a warning about the control that beats the plan, if any. @param by_felt whether the plan
/// was chosen by its percept, at the cost of the pressure.
std::vector<std::string> control_warnings(const Metrics& played,
                                          const std::vector<Control>& controls, bool by_felt);

/// Prints how strongly a stimulus is felt; nothing for a level of NaN.
void print_sensation(std::FILE* out, double level, const SensationInterval& interval);

}  // namespace prostm::app
