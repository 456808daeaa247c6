#pragma once
/// The meaning of answers, which decides how they are analysed.

#include <array>
#include <cstdint>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// The meaning of an answer.
enum class AnswerKind : std::uint8_t {
  Right,    ///< right or wrong
  Felt,     ///< for the level (yes, or its interval) or against it; neither is wrong
  Adjusted  ///< the level at which the stimulus felt like another one
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<AnswerKind> = {"right", "felt", "adjusted"};

}  // namespace prostm
