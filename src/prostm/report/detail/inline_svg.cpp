#include "prostm/report/detail/inline_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace prostm::report::detail {
namespace {

std::string replaced(std::string_view text, std::string_view what, std::string_view with) {
  std::string out;
  for (;;) {
    const std::size_t at = text.find(what);
    out += text.substr(0, at);
    if (at == text.npos) return out;
    out += with;
    text.remove_prefix(at + what.size());
  }
}

/// Truncates the numbers of an outline to two decimals.
std::string shortened(std::string_view outline) {
  std::string out;
  int behind = -1;  // decimals so far; negative before the point
  for (const char c : outline) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (c == '.') {
      behind = 0;
    } else if (digit && behind >= 0) {
      ++behind;
    } else if (!digit) {
      behind = -1;
    }
    if (behind <= 2) out += c;
  }
  return out;
}

/// Shortens all outlines of a picture.
std::string with_short_outlines(std::string_view picture) {
  constexpr std::string_view kBegin = " d=\"";
  std::string out;
  for (;;) {
    const std::size_t at = picture.find(kBegin);
    if (at == picture.npos) return out.append(picture);
    const std::size_t begin = at + kBegin.size();
    const std::size_t end = std::min(picture.find('"', begin), picture.size());
    out += picture.substr(0, begin);
    out += shortened(picture.substr(begin, end - begin));
    picture.remove_prefix(end);
  }
}

/// The value of an attribute of a tag; empty if absent.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string begin = fmt::format(" {}=\"", name);
  const std::size_t at = tag.find(begin);
  if (at == tag.npos) return {};
  tag.remove_prefix(at + begin.size());
  return tag.substr(0, tag.find('"'));
}

}  // namespace

std::string inline_svg(std::string_view picture, std::string_view prefix) {
  const std::size_t begin = picture.find("<svg");
  const std::size_t end = begin == picture.npos ? begin : picture.find('>', begin);
  if (end == picture.npos) throw std::invalid_argument("a picture is not SVG");
  const std::string_view tag = picture.substr(begin, end - begin);
  const std::string_view box = attribute(tag, "viewBox"), width = attribute(tag, "width");
  if (box.empty() || width.empty())
    throw std::invalid_argument("a picture must have a width and a viewBox");
  std::string inner = with_short_outlines(picture.substr(end + 1));
  // remove defaults
  inner = replaced(inner, "stroke:none;fill-rule:nonzero;", "");
  inner = replaced(inner, "fill-opacity:1;", "");
  inner = replaced(inner, " id=\"", fmt::format(" id=\"{}-", prefix));
  inner = replaced(inner, "url(#", fmt::format("url(#{}-", prefix));
  inner = replaced(inner, "xlink:href=\"#", fmt::format("href=\"#{}-", prefix));
  inner = replaced(inner, "xlink:href=", "href=");
  return fmt::format("<svg aria-hidden=\"true\" viewBox=\"{}\" style=\"width:{}\">{}", box, width,
                     inner);
}

}  // namespace prostm::report::detail
