#pragma once
/// Recognises a file by its first bytes, for messages about a file of the wrong kind.

#include <string>
#include <string_view>

namespace prostm {

/// The text without a UTF-8 byte order mark, which some programs write.
std::string_view without_mark(std::string_view text);

/// The kind of file that begins with these bytes: "an HDF5 file", "a PNG picture", "an NPY file",
/// "a zip archive", "text in UTF-16 (save it as UTF-8)" or "JSON"; empty if unknown.
std::string_view kind_by_content(std::string_view bytes);

/// Describes a JSON file by its "format", with its use: "a plan, for prostm field"; empty if
/// unknown.
std::string_view words_of_format(std::string_view format);

/// "is a PNG picture, not JSON", or "is not JSON" if no other kind than `wanted` is recognised.
std::string is_not(std::string_view bytes, std::string_view wanted);

}  // namespace prostm
