#pragma once
/// Transducer arrays in files: prostm-array/1.

#include <span>
#include <string>
#include <string_view>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// @pre validate(array) accepts the array, and its name is UTF-8.
std::string array_to_json(const TransducerArray& array);

/// Normals within 1e-3 of length 1 are made unit vectors.
/// @throws InputError with a sentence: what is not JSON, missing, of another kind, or refused by
/// `validate`.
TransducerArray array_from_json(std::string_view text, const std::string& file);
/// The same from a file. @throws InputError also when it cannot be read.
TransducerArray read_array(const std::string& path);
/// An array of `kinds`, or a file (.json). @throws InputError also for another name.
TransducerArray array_from_name(const std::string& name,
                                std::span<const ArrayKind> kinds = array_kinds());
/// Lists the values of array_from_name(): "usx (default), autd3, or an array file (.json)".
/// @param of_default follows the name of the first, the default.
std::string array_choices(const std::string& of_default = "",
                          std::span<const ArrayKind> kinds = array_kinds());

}  // namespace prostm
