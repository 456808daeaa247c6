#pragma once
/// The sets of fields on which plans are judged.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// Tuning: the twelve kinds of fields::kFeltKinds, only for choosing settings, not for judging.
/// Gallery: three frames of each generated sequence. Scout: the twelve kinds with other seeds.
/// Plumes: four moments of the scene four-plumes on the study's hand. New: eight kinds that are in
/// no other set, three seeds each. Drawn, Redrawn: 24 fields of random parts, the latter for the
/// final judgement alone. Shapes: a ring of 22 mm, a line, a point and a letter.
enum class SetName : std::uint8_t { Tuning, Gallery, Scout, Plumes, New, Drawn, Redrawn, Shapes };

}  // namespace prostm::bench

namespace prostm {
template <>
inline constexpr std::array<std::string_view, 8> kNames<bench::SetName> = {
    "tuning", "gallery", "scout", "plumes", "new", "drawn", "redrawn", "shapes"};
}  // namespace prostm

namespace prostm::bench {

struct NamedField {
  std::string name;
  TargetField field;
};

/// Makes a set. @param most number of its fields, evenly chosen; 0: all. Plumes takes half a
/// minute.
std::vector<NamedField> field_set(SetName set, int most = 0);

}  // namespace prostm::bench
