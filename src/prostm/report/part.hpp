#pragma once
/// The parts of a report. Each is a JSON file with numbers and with the page blocks that show them
/// (prostm-report-part/1 in docs/guides/report.md).

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
  int digits = 3;         ///< decimals of its numbers
};

/// A paragraph. `{/pointer}` stands for a text or whole number of the part's own document, and
/// `{/pointer:2}` for a number with two digits after the point.
nlohmann::ordered_json text_block(const std::string& text);
/// A heading within the part.
nlohmann::ordered_json heading_block(const std::string& text);
/// @param rows objects with a member for each column: a number, a text, true, false, or null for an
/// empty cell. A row's own "digits" overrides that of the columns; a row with "marked": true is
/// highlighted.
nlohmann::ordered_json table_block(const std::string& caption, const std::vector<Column>& columns,
                                   nlohmann::ordered_json rows);
/// @param file an SVG picture in the folder of the parts. @param alt text description of the
/// picture.
nlohmann::ordered_json figure_block(const std::string& file, const std::string& caption,
                                    const std::string& alt);
/// The block, shown without opening the part's details.
nlohmann::ordered_json open_block(nlohmann::ordered_json block);

/// One part of a report.
struct Part {
  std::string name;  ///< name of its file, without .json
  nlohmann::ordered_json document;
};

/// A folder with the files of parts, each complete or absent.
class PartFolder {
 public:
  /// Creates the folder if needed. @throws InputError: it cannot be created or written.
  explicit PartFolder(const std::string& folder);

  /// The path of a file in the folder.
  std::string path(const std::string& file) const;
  /// Reads a part; nothing unless its file was made for the same `asked` and all its pictures
  /// exist.
  std::optional<Part> read(const std::string& name, const nlohmann::ordered_json& asked) const;
  /// Writes a part through a temporary file. @throws InputError: it cannot be written.
  void write(const Part& part) const;

 private:
  std::string folder_;
};

}  // namespace prostm::report
