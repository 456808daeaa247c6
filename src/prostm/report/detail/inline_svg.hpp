#pragma once
/// Inline SVG pictures for an HTML page.

#include <string>
#include <string_view>

namespace prostm::report::detail {

/// Returns the <svg> element of a picture for a page with several: identifiers begin with `prefix`,
/// outlines are truncated to hundredths, and namespaces and defaults are omitted.
/// @throws std::invalid_argument: no <svg> element with
/// a viewBox.
std::string inline_svg(std::string_view picture, std::string_view prefix);

}  // namespace prostm::report::detail
