#include "prostm/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "prostm/report/detail/inline_svg.hpp"
#include "prostm/report/detail/style.hpp"
#include "prostm/report/detail/template.hpp"

namespace prostm::report {
namespace {

using Json = nlohmann::ordered_json;
using kainjow::mustache::data;

/// The text of a cell or a placeholder.
std::string shown(const Json& value, int digits, const std::string& from) {
  if (value.is_null()) return "–";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return rounded(value.get<double>(), digits);
  throw std::invalid_argument(from + " is neither a number nor a text");
}

/// A class of the style sheet: "not comparable" is "not-comparable".
std::string kind_of(std::string agreement) {
  std::ranges::replace(agreement, ' ', '-');
  return agreement;
}

/// The blocks of one part, as data of the template.
class Section {
 public:
  Section(const Part& part, const ReadPicture& read_picture)
      : part_(part), read_picture_(read_picture) {}

  data view() const {
    data open = data::type::list, folded = data::type::list;
    for (const char* list : {"blocks", "timing"}) {
      const Json& blocks = part_.document.at(list);
      for (std::size_t i = 0; i < blocks.size(); ++i)
        (is_open(blocks[i]) ? open : folded)
            .push_back(block_view(blocks[i], fmt::format("/{}/{}", list, i)));
    }
    data out;
    out.set("id", part_.name);
    out.set("heading", part_.document.at("title").get<std::string>());
    out.set("has_folded", folded.is_non_empty_list());
    out.set("open", std::move(open));
    out.set("folded", std::move(folded));
    return out;
  }

 private:
  static bool is_open(const Json& block) {
    return block.contains("verdict") || block.contains("finding") || block.value("open", false);
  }

  std::string from(const std::string& pointer) const {
    return fmt::format("{}.json#{}", part_.name, pointer);
  }

  data block_view(const Json& block, const std::string& pointer) const {
    data out;
    for (const char* kind : {"text", "heading", "verdict", "finding", "table", "figure"}) {
      if (!block.contains(kind)) continue;
      const std::string place = pointer + "/" + kind;
      const std::string name = kind == std::string("heading") ? "subheading" : kind;
      const Json& of = block[kind];
      data inner = of.is_string()           ? with_spans(of.get<std::string>())
                   : of.contains("columns") ? table_view(of, place)
                   : of.contains("file")    ? figure_view(of)
                                            : judged_view(of);
      inner.set("from", from(place));
      out.set(name, std::move(inner));
      return out;
    }
    throw std::invalid_argument(from(pointer) + " is an unknown kind of block");
  }

  /// A verdict or a finding.
  static data judged_view(const Json& of) {
    data out;
    for (const char* key : {"agreement", "section", "link"}) out.set(key, of.value(key, ""));
    out.set("words", of.at("text").get<std::string>());
    out.set("kind", kind_of(of.at("agreement").get<std::string>()));
    return out;
  }

  /// A text with its placeholders filled in.
  data with_spans(const std::string& text) const {
    data spans = data::type::list;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = std::min(text.find("{/", at), text.size());
      spans.push_back(data("plain", text.substr(at, open - at)));
      if (open == text.size()) break;
      const std::size_t close = text.find('}', open);
      if (close == text.npos)
        throw std::invalid_argument(part_.name + ".json: a placeholder has no end: " + text);
      const std::string inner = text.substr(open + 1, close - open - 1);
      const std::size_t colon = std::min(inner.find(':'), inner.size());
      const int digits = colon < inner.size() ? std::stoi(inner.substr(colon + 1)) : 0;
      spans.push_back(data("element", element(inner.substr(0, colon), digits)));
      at = close + 1;
    }
    return data("spans", std::move(spans));
  }

  /// A value of the document.
  data element(const std::string& pointer, int digits) const {
    const Json::json_pointer place(pointer);
    if (!part_.document.contains(place))
      throw std::invalid_argument(part_.name + ".json has no " + pointer);
    const Json& value = part_.document.at(place);
    data out;
    out.set("from", from(pointer));
    out.set("value", shown(value, digits, from(pointer)));
    out.set("n", value.is_number() || value.is_null());
    out.set("digits", value.is_number() ? data(std::to_string(digits)) : data(false));
    return out;
  }

  data table_view(const Json& table, const std::string& pointer) const {
    data out = with_spans(table["caption"]);
    data columns = data::type::list, rows = data::type::list;
    for (std::size_t c = 0; c < table["columns"].size(); ++c) {
      const Json& of = table["columns"][c];
      const std::string unit = of["unit"];
      data column;
      column.set("from", from(fmt::format("{}/columns/{}", pointer, c)));
      column.set("name", of["name"].get<std::string>());
      column.set("unit", unit.empty() ? data(false) : data(unit));
      column.set("n", std::ranges::any_of(table["rows"], [&](const Json& row) {
                   return row.value(of["key"].get<std::string>(), Json()).is_number();
                 }));
      columns.push_back(std::move(column));
    }
    for (std::size_t r = 0; r < table["rows"].size(); ++r) {
      const Json& of = table["rows"][r];
      data cells = data::type::list;
      for (const Json& column : table["columns"])
        cells.push_back(
            element(fmt::format("{}/rows/{}/{}", pointer, r, column["key"].get<std::string>()),
                    of.value("digits", column["digits"].get<int>())));
      data row("cells", std::move(cells));
      row.set("marked", of.value("marked", false));
      rows.push_back(std::move(row));
    }
    out.set("columns", std::move(columns));
    out.set("rows", std::move(rows));
    return out;
  }

  data figure_view(const Json& figure) const {
    const std::string file = figure["file"];
    data out = with_spans(figure["caption"]);
    out.set("alt", figure["alt"].get<std::string>());
    out.set("svg", detail::inline_svg(read_picture_(file), file.substr(0, file.find('.'))));
    return out;
  }

  const Part& part_;
  const ReadPicture& read_picture_;
};

data partial(std::string_view text) {
  return kainjow::mustache::partial([text] { return std::string(text); });
}

}  // namespace

std::string rounded(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_of("123456789") == text.npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

std::string page_html(const std::string& title, std::span<const Part> parts,
                      const ReadPicture& read_picture) {
  data sections = data::type::list;
  for (const Part& part : parts) {
    if (part.document.at("blocks").empty() && part.document.at("timing").empty()) continue;
    sections.push_back(Section(part, read_picture).view());
  }
  data page;
  page.set("title", title);
  page.set("style", std::string(detail::kStyle));
  page.set("parts", std::move(sections));
  page.set("block", partial(detail::kBlock));
  page.set("inline", partial(detail::kInline));
  kainjow::mustache::mustache form{std::string(detail::kPage)};
  const std::string html = form.render(page);
  if (!form.is_valid()) throw std::logic_error("the page's template: " + form.error_message());
  return html;
}

}  // namespace prostm::report
