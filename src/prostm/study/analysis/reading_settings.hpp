#pragma once
/// How files of answers are read.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// A prefix of participants' names, so that two people with one name are told apart.
enum class IdPrefix : std::uint8_t {
  None,    ///< a name that is in several files is of one person
  Folder,  ///< the file's folder
  File     ///< the file's name, with its folder where that is needed
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<IdPrefix> = {"none", "folder", "file"};

/// How files of answers are read.
struct ReadingSettings {
  std::string columns;              ///< of tables: "correct=key_resp.corr,method:=am"
  std::vector<std::string> rename;  ///< "participant:OLD=NEW", also method: and scene:
  std::optional<IdPrefix> prefix;   ///< nothing: a name in several files is refused
  bool merge_spellings = false;     ///< names that differ in spelling alone are one
  bool pool = false;                ///< answers to different stimuli are taken together
};

}  // namespace prostm
