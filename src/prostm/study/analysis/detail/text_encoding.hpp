#pragma once
/// Decodes text files in the encodings written by spreadsheets and experiment software.

#include <string>
#include <string_view>

namespace prostm::study {

/// A text in UTF-8 without a byte order mark.
struct DecodedText {
  std::string text;
  /// the assumed encoding, if nothing in the file identifies it; else empty
  std::string assumed = {};
};

/// Converts a file to UTF-8. UTF-8 and UTF-16 are recognised by their byte order mark, UTF-16
/// without one by its zero bytes, UTF-8 by being valid. Everything else is read as Windows-1252,
/// which includes Latin-1 text. @param file name for messages. @throws InputError: a spreadsheet's
/// own format, UTF-16 that is truncated or invalid.
DecodedText decode_text(std::string_view bytes, const std::string& file);

}  // namespace prostm::study
