#pragma once
/// Hints for converting files of other programs into a field. Private to io.

#include <string>
#include <string_view>

namespace prostm {

/// Returns how to convert a file of another format to .npy or .png, with the order of its axes,
/// e.g. "convert it with Python: …"; empty for an unknown extension. @param ending file extension
/// in lower case, with its dot.
std::string conversion_hint(std::string_view ending);

}  // namespace prostm
