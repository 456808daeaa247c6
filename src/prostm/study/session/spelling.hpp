#pragma once
/// Names that differ in spelling alone.

#include <string>
#include <string_view>

namespace prostm::study {

/// Returns a name without white space and invisible characters at its ends, those of Unicode
/// included. @pre UTF-8.
std::string trimmed(std::string_view name);

/// Returns what names that differ in spelling alone have in common: without leading zeros of whole
/// numbers and zeros after their decimal mark ("01", "1", "1.0"), in Unicode's form NFKC_Casefold
/// (UAX 31: small letters, composed accents, full-width characters as ASCII, nothing invisible),
/// and with one "-" in place of white space, underscores and dashes. @pre UTF-8.
std::string spelling_key(std::string_view name);

}  // namespace prostm::study
