#include "prostm/study/session/spelling.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace prostm::study {
namespace {

bool is_blank(utf8proc_int32_t c) {
  const utf8proc_category_t kind = utf8proc_category(c);
  return (c >= 0x09 && c <= 0x0D) || c == 0x85 || kind == UTF8PROC_CATEGORY_ZS ||
         kind == UTF8PROC_CATEGORY_ZL || kind == UTF8PROC_CATEGORY_ZP;
}

/// Zero-width characters, direction marks, soft hyphens and byte order marks.
bool is_invisible(utf8proc_int32_t c) {
  return utf8proc_category(c) == UTF8PROC_CATEGORY_CF;
}

bool is_dash(utf8proc_int32_t c) {
  constexpr utf8proc_int32_t kMinus = 0x2212;
  return c == '_' || c == kMinus || utf8proc_category(c) == UTF8PROC_CATEGORY_PD;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Calls `use` with each character and its bytes; skips bytes that are not valid UTF-8.
template <class Use>
void each_character(std::string_view text, const Use& use) {
  const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
  for (std::size_t at = 0; at < text.size();) {
    utf8proc_int32_t c = 0;
    const auto size =
        utf8proc_iterate(bytes + at, static_cast<utf8proc_ssize_t>(text.size() - at), &c);
    if (size > 0) use(c, text.substr(at, static_cast<std::size_t>(size)));
    at += static_cast<std::size_t>(std::max<utf8proc_ssize_t>(size, 1));
  }
}

/// The text in Unicode's form NFKC_Casefold; empty if it is not valid UTF-8.
std::string folded(std::string_view text) {
  constexpr auto kForm = static_cast<utf8proc_option_t>(
      UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_COMPAT | UTF8PROC_CASEFOLD | UTF8PROC_IGNORE);
  utf8proc_uint8_t* out = nullptr;
  const auto size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                 static_cast<utf8proc_ssize_t>(text.size()), &out, kForm);
  const std::unique_ptr<utf8proc_uint8_t, void (*)(void*)> owner(out, std::free);
  if (size < 0) return {};
  return {reinterpret_cast<const char*>(out), static_cast<std::size_t>(size)};
}

/// Removes leading zeros of whole numbers, and a decimal mark followed only by zeros. Other
/// fractions keep their digits.
std::string with_plain_numbers(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_digit(text[at])) {
      out += text[at++];
      continue;
    }
    const auto end_of = [&](std::size_t from, auto is_in) {
      while (from < text.size() && is_in(text[from])) ++from;
      return from;
    };
    const auto is_zero = [](char c) { return c == '0'; };
    const std::size_t end = end_of(at, is_digit);
    const std::size_t first = std::min(end_of(at, is_zero), end - 1);
    out += text.substr(first, end - first);
    at = end;
    if (at + 1 >= text.size() || (text[at] != '.' && text[at] != ',')) continue;
    const std::size_t after = end_of(at + 1, is_digit);
    if (after > at + 1 && end_of(at + 1, is_zero) < after) out += text.substr(at, after - at);
    if (after > at + 1) at = after;
  }
  return out;
}

}  // namespace

std::string trimmed(std::string_view name) {
  std::size_t first = name.size(), last = 0;
  each_character(name, [&](utf8proc_int32_t c, std::string_view bytes) {
    if (is_blank(c) || is_invisible(c)) return;
    const auto at = static_cast<std::size_t>(bytes.data() - name.data());
    first = std::min(first, at);
    last = at + bytes.size();
  });
  return first < last ? std::string(name.substr(first, last - first)) : std::string();
}

std::string spelling_key(std::string_view name) {
  std::string out;
  each_character(folded(trimmed(name)), [&](utf8proc_int32_t c, std::string_view bytes) {
    if (is_invisible(c)) return;
    if (!is_blank(c) && !is_dash(c)) {
      out += bytes;
    } else if (out.empty() || out.back() != '-') {
      out += '-';
    }
  });
  return with_plain_numbers(out);
}

}  // namespace prostm::study
