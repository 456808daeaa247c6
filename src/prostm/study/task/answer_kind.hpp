#pragma once
/// The meaning of answers, by which they are analysed.

#include <array>
#include <cstdint>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// The meaning of an answer.
enum class AnswerKind : std::uint8_t {
  Right,    ///< it was right or wrong
  Felt,     ///< it was for the level or not: yes, or its interval, and neither is wrong
  Adjusted  ///< the level was tuned until it felt like another stimulus
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<AnswerKind> = {"right", "felt", "adjusted"};

}  // namespace prostm
