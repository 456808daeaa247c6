#pragma once
/// Transducer arrays in files: prostm-array/1.

#include <span>
#include <string>
#include <string_view>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// @pre validate(array) accepts the array, and its name is UTF-8.
std::string array_to_json(const TransducerArray& array);

/// Reads an array. Normals within 1e-3 of length 1 are normalised. @throws InputError: not JSON, a
/// missing member or one of another type, or an array refused by `validate`.
TransducerArray array_from_json(std::string_view text, const std::string& file);
/// Reads an array file. @throws InputError also if it cannot be read.
TransducerArray read_array(const std::string& path);
/// Returns an array of `kinds`, or reads a file (.json). @throws InputError also for an unknown
/// name.
TransducerArray array_from_name(const std::string& name,
                                std::span<const ArrayKind> kinds = array_kinds());
/// Lists the values of array_from_name(): "usx (default), autd3, or an array file (.json)".
/// @param of_default text after the name of the first, the default.
std::string array_choices(const std::string& of_default = "",
                          std::span<const ArrayKind> kinds = array_kinds());

}  // namespace prostm
