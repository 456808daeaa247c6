#include "prostm/study/analysis/detail/text_encoding.hpp"

#include <array>
#include <boost/locale/utf.hpp>
#include <cstdint>
#include <iterator>

#include "prostm/core/input_error.hpp"

namespace prostm::study {
namespace {

namespace utf = boost::locale::utf;

/// Code points of the bytes 0x80 to 0x9F in Windows-1252; its five unused bytes map to themselves.
constexpr std::array<char16_t, 32> kWindows1252 = {
    0x20AC, 0x0081, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0x008D, 0x017D, 0x008F, 0x0090, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x009D, 0x017E, 0x0178};

void append(std::string& out, utf::code_point c) {
  utf::utf_traits<char>::encode(c, std::back_inserter(out));
}

bool is_utf8(std::string_view bytes) {
  for (const char *at = bytes.data(), *end = at + bytes.size(); at != end;) {
    if (!utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, end))) return false;
  }
  return true;
}

std::string from_windows_1252(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    append(out, byte >= 0x80 && byte < 0xA0 ? kWindows1252[byte - 0x80U] : byte);
  }
  return out;
}

std::string from_utf16(std::string_view bytes, bool big_endian, const std::string& file) {
  if (bytes.size() % 2 != 0) throw InputError(file + ": UTF-16 text is cut off within a character");
  std::u16string units;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto first = static_cast<unsigned char>(bytes[i]),
               second = static_cast<unsigned char>(bytes[i + 1]);
    units += static_cast<char16_t>(big_endian ? first << 8U | second : second << 8U | first);
  }
  std::string out;
  for (auto at = units.cbegin(); at != units.cend();) {
    const utf::code_point c = utf::utf_traits<char16_t>::decode(at, units.cend());
    if (!utf::is_valid_codepoint(c))
      throw InputError(file + ": is not valid UTF-16; save it as CSV in UTF-8");
    append(out, c);
  }
  return out;
}

/// Whether every second byte at the beginning is zero, as in UTF-16 text of Latin letters.
bool has_zeros_from(std::string_view bytes, std::size_t first) {
  constexpr std::size_t kLooked = 16;
  if (bytes.size() < 4) return false;
  for (std::size_t i = 0; i < std::min(bytes.size(), kLooked); ++i) {
    if ((bytes[i] == '\0') != (i % 2 == first)) return false;
  }
  return true;
}

}  // namespace

DecodedText decode_text(std::string_view bytes, const std::string& file) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("PK\x03\x04"sv) || bytes.starts_with("\xD0\xCF\x11\xE0"sv)) {
    throw InputError(
        file +
        ": is a spreadsheet's own format; save it as CSV in UTF-8 (Excel: Save As, CSV "
        "UTF-8; LibreOffice: Save As, Text CSV)");
  }
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
  if (bytes.starts_with("\xFF\xFE"sv)) return {from_utf16(bytes.substr(2), false, file)};
  if (bytes.starts_with("\xFE\xFF"sv)) return {from_utf16(bytes.substr(2), true, file)};
  if (has_zeros_from(bytes, 1)) return {from_utf16(bytes, false, file), "UTF-16"};
  if (has_zeros_from(bytes, 0)) return {from_utf16(bytes, true, file), "UTF-16"};
  if (is_utf8(bytes)) return {std::string(bytes)};
  return {from_windows_1252(bytes), "Windows-1252"};
}

}  // namespace prostm::study
