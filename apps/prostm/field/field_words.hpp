#pragma once
/// The sentences of `prostm plan` about a field that it has read, and about its plan.

#include <string>
#include <vector>

#include "prostm/io/field/field_file.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// One line about a field as it was understood: size, cells, skin, largest pressure and its unit.
std::string field_in_words(const std::string& path, FieldKind kind, const TargetField& field,
                           const FieldFileOptions& options);

/// A sentence for each sign that the field is not what its author had in mind.
std::vector<std::string> field_warnings(FieldKind kind, const TargetField& field,
                                        const FieldFileOptions& options);

/// One sentence that judges a plan for people who do not know the metrics. @param played metrics of
/// what is played of the plan. @param by_felt whether it was chosen by what is felt, at the cost of
/// the pressure.
std::string verdict(const TargetField& field, const Plan& plan, const Metrics& played,
                    bool by_felt);

/// A sentence about the control that beats the plan, if any does. @param by_felt as of verdict().
std::vector<std::string> control_warnings(const Metrics& played,
                                          const std::vector<Control>& controls, bool by_felt);

}  // namespace prostm::app
