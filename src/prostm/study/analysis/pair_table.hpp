#pragma once
/// Reads tables of paired comparisons.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/study/analysis/bradley_terry.hpp"

namespace prostm {

/// Treatment of comparisons in which neither stimulus was preferred.
enum class Ties : std::uint8_t {
  Refuse,
  Half,  ///< half a preference for each
  Omit
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Ties> = {"refuse", "half", "omit"};

/// Reads a table with the columns a, b and preferred, and optionally participant: in each row two
/// stimuli, and the preferred one by its name, or "tie". Encodings and separators as for
/// answers_from_csv(). A row without a preference is left out, with a note.
/// @throws InputError with the line: a missing column or name, a preferred stimulus that is not one
/// of the two, a tie that is refused.
std::vector<PairedComparison> comparisons_from_csv(std::string_view text, const std::string& file,
                                                   Ties ties, std::vector<std::string>& notes);

/// Whether a table has the columns a, b and preferred. False for files that are no tables.
bool is_pair_table(std::string_view text, const std::string& file);

/// Returns whether these files are tables of paired comparisons. @throws InputError: some are and
/// some are not, or a file cannot be read.
bool are_pair_tables(std::span<const std::string> paths);

/// Reads several tables as comparisons_from_csv(). @throws InputError as that, and for a file with
/// the same content as another.
std::vector<PairedComparison> read_comparisons(std::span<const std::string> paths, Ties ties,
                                               std::vector<std::string>& notes);

}  // namespace prostm
