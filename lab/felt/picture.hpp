#pragma once
/// A picture of the percepts of some fields.

#include <string>
#include <vector>

#include "felt/field_sets.hpp"
#include "felt/tables.hpp"

namespace prostm::bench {

/// Draws each field's target, and the map √e of each way beside it; at most six fields, evenly
/// chosen. @param fields those of the set. @throws InputError when the file cannot be written.
void draw_felt(const JudgedSet& set, const std::vector<NamedField>& fields,
               const std::string& path);

}  // namespace prostm::bench
