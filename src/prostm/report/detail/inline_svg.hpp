#pragma once
/// Pictures as parts of an HTML page.

#include <string>
#include <string_view>

namespace prostm::report::detail {

/// Returns the <svg> element of a picture for a page that holds several: its identifiers begin with
/// `prefix`, its outlines are cut to hundredths, and it names neither namespaces nor what is the
/// default.
/// @param alt what it shows. @throws std::invalid_argument: no <svg> element with a viewBox.
std::string inline_svg(std::string_view picture, std::string_view prefix, std::string_view alt);

}  // namespace prostm::report::detail
