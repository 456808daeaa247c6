#pragma once
/// The parts of a report: each is a JSON file with its numbers and with the blocks of the page that
/// show them, prostm-report-part/1 of docs/guides/report.md.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace prostm::report {

/// A column of a table.
struct Column {
  std::string key;        ///< member of each row
  std::string name;       ///< heading
  std::string unit = {};  ///< under the heading
  int digits = 3;         ///< after the point of its numbers
};

/// A paragraph. `{/pointer}` stands for a text or whole number of the part's own document, and
/// `{/pointer:2}` for a number with two digits after the point.
nlohmann::ordered_json text_block(const std::string& text);
/// A heading within the part.
nlohmann::ordered_json heading_block(const std::string& text);
/// @param rows objects with a member for each column: a number, a text, true, false, or null where
/// there is nothing. A row's own "digits" replaces that of the columns, and one with "marked": true
/// stands apart.
nlohmann::ordered_json table_block(const std::string& caption, const std::vector<Column>& columns,
                                   nlohmann::ordered_json rows);
/// @param file an SVG picture in the folder of the parts. @param alt what it shows.
nlohmann::ordered_json figure_block(const std::string& file, const std::string& caption,
                                    const std::string& alt);

/// One part of a report.
struct Part {
  std::string name;  ///< of its file, NAME.json
  nlohmann::ordered_json document;
};

/// A folder with the files of parts, which are whole or not there.
class PartFolder {
 public:
  /// Makes the folder where it is not there. @throws InputError: it cannot be made or written.
  explicit PartFolder(const std::string& folder);

  /// The name of a file in it.
  std::string path(const std::string& file) const;
  /// Reads the part, where its file was made for the same `asked` and all its pictures are there.
  std::optional<Part> read(const std::string& name, const nlohmann::ordered_json& asked) const;
  /// Writes a part through a temporary file. @throws InputError: it cannot be written.
  void write(const Part& part) const;

 private:
  std::string folder_;
};

}  // namespace prostm::report
