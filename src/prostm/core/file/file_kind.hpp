#pragma once
/// Recognises a file by its first bytes, for messages about a file of the wrong kind.

#include <string>
#include <string_view>

namespace prostm {

/// The text without UTF-8's byte order mark, which some programs write before it.
std::string_view without_mark(std::string_view text);

/// The kind of file that begins with these bytes: "an HDF5 file", "a PNG picture", "an NPY file",
/// "a zip archive", "text in UTF-16 (save it as UTF-8)" or "JSON"; empty if unknown.
std::string_view kind_by_content(std::string_view bytes);

/// The contents of a JSON file by its "format", and what takes them: "a plan, for prostm field";
/// empty if unknown.
std::string_view words_of_format(std::string_view format);

/// "is a PNG picture, not JSON", or "is not JSON" if the bytes tell no other kind than `wanted`.
std::string is_not(std::string_view bytes, std::string_view wanted);

}  // namespace prostm
