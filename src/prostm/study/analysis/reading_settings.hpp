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

/// Prefix of participants' names, to distinguish people with the same name.
enum class IdPrefix : std::uint8_t {
  None,    ///< a name in several files is one person
  Folder,  ///< the file's folder
  File     ///< the file's name, with its folder if needed
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<IdPrefix> = {"none", "folder", "file"};

/// How files of answers are read.
struct ReadingSettings {
  std::string columns;              ///< column names of tables: "correct=key_resp.corr,method:=am"
  std::vector<std::string> rename;  ///< "participant:OLD=NEW", also method: and scene:
  std::optional<IdPrefix> prefix;   ///< nothing: a name in several files is refused
  bool merge_spellings = false;     ///< treat names that differ only in spelling as one
  bool pool = false;                ///< combine answers to different stimuli
};

}  // namespace prostm
