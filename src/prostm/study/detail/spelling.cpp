#include "prostm/study/detail/spelling.hpp"

#include <algorithm>
#include <array>
#include <boost/locale/encoding_utf.hpp>

namespace prostm::study {
namespace {

namespace conv = boost::locale::conv;

bool is_blank(char32_t c) {
  return (c >= 0x09 && c <= 0x0D) || c == 0x20 || c == 0x85 || c == 0xA0 || c == 0x1680 ||
         (c >= 0x2000 && c <= 0x200A) || c == 0x2028 || c == 0x2029 || c == 0x202F || c == 0x205F ||
         c == 0x3000;
}

/// Zero-width characters, direction marks, soft hyphens and byte order marks.
bool is_invisible(char32_t c) {
  return c == 0xAD || c == 0x180E || (c >= 0x200B && c <= 0x200F) || (c >= 0x202A && c <= 0x202E) ||
         (c >= 0x2060 && c <= 0x2064) || (c >= 0x2066 && c <= 0x2069) || c == 0xFEFF;
}

bool is_dash(char32_t c) {
  return c == U'-' || c == U'_' || (c >= 0x2010 && c <= 0x2015) || c == 0x2212;
}

bool is_digit(char32_t c) {
  return c >= U'0' && c <= U'9';
}

/// Full-width forms of ASCII as ASCII.
char32_t narrow(char32_t c) {
  return c >= 0xFF01 && c <= 0xFF5E ? c - 0xFEE0 : c;
}

char32_t lower(char32_t c) {
  const auto in = [c](char32_t low, char32_t high) { return c >= low && c <= high; };
  if (in(U'A', U'Z') || (in(0xC0, 0xDE) && c != 0xD7)) return c + 32;
  if (in(0x0100, 0x0137) || in(0x014A, 0x0177)) return c | 1U;
  if (in(0x0139, 0x0148) || in(0x0179, 0x017E)) return c + (c & 1U);
  if (c == 0x0178) return 0xFF;
  if (in(0x0391, 0x03A9) || in(0x0410, 0x042F)) return c + 32;
  if (in(0x0400, 0x040F)) return c + 80;
  return c;
}

/// Small letters with a combining mark, and as one character; of Latin-1 and Latin Extended-A.
struct Accents {
  char32_t mark;
  std::u32string_view letters, composed;
};
constexpr std::array kAccents = {
    Accents{0x300, U"aeiou", U"àèìòù"},
    Accents{0x301, U"aeiouyclnrsz", U"áéíóúýćĺńŕśź"},
    Accents{0x302, U"aeioucghjswy", U"âêîôûĉĝĥĵŝŵŷ"},
    Accents{0x303, U"anoiu", U"ãñõĩũ"},
    Accents{0x304, U"aeiou", U"āēīōū"},
    Accents{0x306, U"aegiou", U"ăĕğĭŏŭ"},
    Accents{0x307, U"cegz", U"ċėġż"},
    Accents{0x308, U"aeiouy", U"äëïöüÿ"},
    Accents{0x30A, U"au", U"åů"},
    Accents{0x30B, U"ou", U"őű"},
    Accents{0x30C, U"cdelnrstz", U"čďěľňřšťž"},
    Accents{0x327, U"cgklnrst", U"çģķļņŗşţ"},
    Accents{0x328, U"aeiu", U"ąęįų"},
};

/// Appends a character, joined with the letter before it if it is that letter's mark.
void append_composed(std::u32string& out, char32_t c) {
  const auto of = std::find_if(kAccents.begin(), kAccents.end(),
                               [&](const Accents& accents) { return accents.mark == c; });
  const std::size_t at = of == kAccents.end() || out.empty() ? std::u32string_view::npos
                                                             : of->letters.find(out.back());
  if (at == std::u32string_view::npos) {
    out += c;
  } else {
    out.back() = of->composed[at];
  }
}

/// Leaves out leading zeros of whole numbers, and the decimal mark with the zeros after it where
/// nothing else follows it. A fraction keeps its digits.
std::u32string with_plain_numbers(const std::u32string& text) {
  std::u32string out;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_digit(text[at])) {
      out += text[at++];
      continue;
    }
    const auto end_of = [&](std::size_t from, auto is_in) {
      while (from < text.size() && is_in(text[from])) ++from;
      return from;
    };
    const auto is_zero = [](char32_t c) { return c == U'0'; };
    const std::size_t end = end_of(at, is_digit);
    const std::size_t first = std::min(end_of(at, is_zero), end - 1);
    out += text.substr(first, end - first);
    at = end;
    if (at + 1 >= text.size() || (text[at] != U'.' && text[at] != U',')) continue;
    const std::size_t after = end_of(at + 1, is_digit);
    if (after > at + 1 && end_of(at + 1, is_zero) < after) out += text.substr(at, after - at);
    if (after > at + 1) at = after;
  }
  return out;
}

}  // namespace

std::string trimmed(std::string_view name) {
  const std::u32string text = conv::utf_to_utf<char32_t>(name.data(), name.data() + name.size());
  const auto is_shown = [](char32_t c) { return !is_blank(c) && !is_invisible(c); };
  const auto first = std::find_if(text.begin(), text.end(), is_shown);
  const auto last = std::find_if(text.rbegin(), text.rend(), is_shown).base();
  if (first >= last) return {};
  return conv::utf_to_utf<char>(&*first, &*first + (last - first));
}

std::string spelling_key(std::string_view name) {
  const std::string inside = trimmed(name);
  std::u32string out;
  for (const char32_t from : conv::utf_to_utf<char32_t>(inside)) {
    if (is_invisible(from)) continue;
    const char32_t c = lower(narrow(from));
    if (!is_blank(c) && !is_dash(c)) {
      append_composed(out, c);
    } else if (out.empty() || out.back() != U'-') {
      out += U'-';
    }
  }
  return conv::utf_to_utf<char>(with_plain_numbers(out));
}

}  // namespace prostm::study
