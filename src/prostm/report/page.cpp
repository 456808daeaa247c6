#include "prostm/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "prostm/report/detail/inline_svg.hpp"
#include "prostm/report/detail/style.hpp"

namespace prostm::report {
namespace {

using Json = nlohmann::ordered_json;

/// The text of a cell or a placeholder: plain, not HTML.
std::string shown(const Json& value, int digits, const std::string& from) {
  if (value.is_null()) return "–";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return rounded(value.get<double>(), digits);
  throw std::invalid_argument(from + " is neither a number nor a text");
}

/// Blocks of one part as HTML.
class Section {
 public:
  Section(const Part& part, const ReadPicture& read_picture)
      : part_(part), read_picture_(read_picture) {}

  std::string html() {
    const std::string& title = part_.document.at("title").get_ref<const std::string&>();
    out_ = fmt::format("<section id=\"{}\">\n<h2{}>{}</h2>\n", escaped(part_.name), from("/title"),
                       escaped(title));
    for (const char* list : {"blocks", "timing"}) {
      const Json& blocks = part_.document.at(list);
      for (std::size_t i = 0; i < blocks.size(); ++i)
        add(blocks[i], fmt::format("/{}/{}", list, i));
    }
    return out_ + "</section>\n";
  }

 private:
  std::string from(const std::string& pointer) const {
    return fmt::format(" data-from=\"{}.json#{}\"", escaped(part_.name), escaped(pointer));
  }

  void add(const Json& block, const std::string& pointer) {
    if (block.contains("text")) {
      out_ += fmt::format("<p{}>{}</p>\n", from(pointer + "/text"), paragraph(block["text"]));
    } else if (block.contains("heading")) {
      out_ +=
          fmt::format("<h3{}>{}</h3>\n", from(pointer + "/heading"), paragraph(block["heading"]));
    } else if (block.contains("table")) {
      add_table(block["table"], pointer + "/table");
    } else if (block.contains("figure")) {
      add_figure(block["figure"], pointer + "/figure");
    } else {
      throw std::invalid_argument(part_.name + ".json: " + pointer +
                                  " is an unknown kind of block");
    }
  }

  /// A text with its placeholders filled in.
  std::string paragraph(const std::string& text) const {
    std::string html;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = std::min(text.find("{/", at), text.size());
      html += escaped(std::string_view(text).substr(at, open - at));
      if (open == text.size()) break;
      const std::size_t close = text.find('}', open);
      if (close == text.npos)
        throw std::invalid_argument(part_.name + ".json: a placeholder has no end: " + text);
      html += placeholder(text.substr(open + 1, close - open - 1));
      at = close + 1;
    }
    return html;
  }

  std::string placeholder(const std::string& inner) const {
    const std::size_t colon = std::min(inner.find(':'), inner.size());
    const std::string pointer = inner.substr(0, colon);
    const int digits = colon < inner.size() ? std::stoi(inner.substr(colon + 1)) : 0;
    return element("span", pointer, digits);
  }

  /// Whether a column has numbers, and is right-aligned.
  static bool is_of_numbers(const Json& column, const Json& rows) {
    const std::string key = column["key"];
    return std::ranges::any_of(
        rows, [&](const Json& row) { return row.contains(key) && row[key].is_number(); });
  }

  /// An element that shows a value of the document.
  std::string element(const char* tag, const std::string& pointer, int digits) const {
    const Json::json_pointer place(pointer);
    if (!part_.document.contains(place))
      throw std::invalid_argument(part_.name + ".json has no " + pointer);
    const Json& value = part_.document.at(place);
    std::string number;
    if (value.is_number()) number = fmt::format(" data-digits=\"{}\" class=\"n\"", digits);
    if (value.is_null()) number = " class=\"n\"";
    return fmt::format("<{0}{1}{2}>{3}</{0}>", tag, from(pointer), number,
                       escaped(shown(value, digits, part_.name + ".json#" + pointer)));
  }

  void add_table(const Json& table, const std::string& pointer) {
    // outside the scrolling box, so that it does not scroll with a wide table
    out_ += fmt::format("<p class=\"caption\"{}>{}</p>\n", from(pointer + "/caption"),
                        paragraph(table["caption"]));
    out_ += "<div class=\"scroll\"><table>\n<thead><tr>";
    const Json& columns = table["columns"];
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::string place = fmt::format("{}/columns/{}", pointer, c);
      out_ += fmt::format("<th scope=\"col\"{}><span{}>{}</span>",
                          is_of_numbers(columns[c], table["rows"]) ? " class=\"n\"" : "",
                          from(place + "/name"), escaped(columns[c]["name"].get<std::string>()));
      const std::string unit = columns[c]["unit"];
      if (!unit.empty()) {
        out_ += fmt::format("<br><small{}>{}</small>", from(place + "/unit"), escaped(unit));
      }
      out_ += "</th>";
    }
    out_ += "</tr></thead>\n<tbody>\n";
    const Json& rows = table["rows"];
    for (std::size_t r = 0; r < rows.size(); ++r)
      add_row(columns, rows[r], fmt::format("{}/rows/{}", pointer, r));
    out_ += "</tbody></table></div>\n";
  }

  void add_row(const Json& columns, const Json& row, const std::string& pointer) {
    out_ += row.value("marked", false) ? "<tr class=\"marked\">" : "<tr>";
    for (const Json& column : columns) {
      const int digits = row.value("digits", column["digits"].get<int>());
      out_ +=
          element("td", fmt::format("{}/{}", pointer, column["key"].get<std::string>()), digits);
    }
    out_ += "</tr>\n";
  }

  void add_figure(const Json& figure, const std::string& pointer) {
    const std::string file = figure["file"];
    const std::string prefix = file.substr(0, file.find('.'));
    out_ += fmt::format(
        "<figure><div class=\"card\">{}</div>\n<figcaption{}>{}</figcaption></figure>\n",
        detail::inline_svg(read_picture_(file), prefix, figure["alt"].get<std::string>()),
        from(pointer + "/caption"), paragraph(figure["caption"]));
  }

  const Part& part_;
  const ReadPicture& read_picture_;
  std::string out_;
};

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string rounded(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_of("123456789") == text.npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

std::string page_html(const std::string& title, std::span<const Part> parts,
                      const ReadPicture& read_picture) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{0}</title>\n<style>{1}</style></head>\n<body>\n<header><h1>{0}</h1></header>\n"
      "<nav aria-label=\"Parts\"><ul>\n",
      escaped(title), detail::kStyle);
  for (const Part& part : parts) {
    out += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(part.name),
                       escaped(part.document.at("title").get<std::string>()));
  }
  out += "</ul></nav>\n<main>\n";
  for (const Part& part : parts) out += Section(part, read_picture).html();
  return out + "</main>\n</body></html>\n";
}

}  // namespace prostm::report
