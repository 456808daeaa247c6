#pragma once
/// Bytes as text, RFC 4648.

#include <string>
#include <string_view>

namespace prostm::report::detail {

std::string base64(std::string_view bytes);

}  // namespace prostm::report::detail
