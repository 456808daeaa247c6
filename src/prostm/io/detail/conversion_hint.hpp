#pragma once
/// How to convert files of other programs into a field. Private to io.

#include <string>
#include <string_view>

namespace prostm {

/// How to convert a file of another format to .npy or .png, with the order of its axes, e.g.
/// "convert it with Python: …"; empty for an ending that is unknown.
/// @param ending of the file's name in small letters, with its dot.
std::string conversion_hint(std::string_view ending);

}  // namespace prostm
