#pragma once
/// How a field is rendered.

#include <cstdint>
#include <string>

namespace prostm {

/// `pro-stm`: focal points that run round closed paths. `am`: focal points that stand still, their
/// intensity modulated.
enum class Method : std::uint8_t { ProStm, Am };

/// @throws std::invalid_argument with a sentence for a name that is unknown.
Method method_from_name(const std::string& name);
std::string to_string(Method method);

}  // namespace prostm
