#pragma once
/// Methods of rendering a field.

#include <array>
#include <cstdint>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// `pro-stm`: focal points that move along closed paths. `am`: stationary focal points with
/// amplitude modulation.
enum class Method : std::uint8_t { ProStm, Am };
template <>
inline constexpr std::array<std::string_view, 2> kNames<Method> = {"pro-stm", "am"};

}  // namespace prostm
