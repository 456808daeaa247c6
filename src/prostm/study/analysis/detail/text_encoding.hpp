#pragma once
/// Text files in the encodings that spreadsheets and experiment software write.

#include <string>
#include <string_view>

namespace prostm::study {

/// A text in UTF-8 without a byte order mark.
struct DecodedText {
  std::string text;
  /// the encoding of the file if it was assumed, since nothing in the file names it; else empty
  std::string assumed = {};
};

/// Converts a file to UTF-8. UTF-8 and UTF-16 are recognised by their byte order mark, UTF-16
/// without one by its zero bytes, UTF-8 by being valid. Everything else is read as Windows-1252, of
/// which Latin-1 text is a part. @param file for messages. @throws InputError: a spreadsheet's own
/// format, UTF-16 that is cut off or not valid.
DecodedText decode_text(std::string_view bytes, const std::string& file);

}  // namespace prostm::study
