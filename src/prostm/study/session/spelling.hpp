#pragma once
/// Comparison of names that differ only in spelling.

#include <string>
#include <string_view>

namespace prostm::study {

/// Returns a name without white space and invisible characters (including Unicode's) at its ends.
/// @pre UTF-8.
std::string trimmed(std::string_view name);

/// Returns a key that is equal for names that differ only in spelling: whole numbers without
/// leading zeros and without zero decimals ("01", "1", "1.0"), in Unicode's form NFKC_Casefold (UAX
/// 31: small letters, composed accents, full-width characters as ASCII, nothing invisible), and
/// with one "-" in place of white space, underscores and dashes. @pre UTF-8.
std::string spelling_key(std::string_view name);

}  // namespace prostm::study
