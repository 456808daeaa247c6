#include "prostm/report/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"

namespace prostm::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Whether all files named by a part are in the folder.
bool has_files(const Json& document, const fs::path& folder) {
  const auto is_there = [&](const Json& name) {
    return name.is_string() && fs::is_regular_file(folder / name.get<std::string>());
  };
  const Json files = document.value("files", Json::array());
  if (!std::ranges::all_of(files, is_there)) return false;
  for (const char* list : {"blocks", "timing"}) {
    if (!document.contains(list) || !document[list].is_array()) return false;
    for (const Json& block : document[list]) {
      if (block.contains("figure") && !is_there(block["figure"].value("file", Json())))
        return false;
    }
  }
  return true;
}

}  // namespace

Json open_block(Json block) {
  block["open"] = true;
  return block;
}

Json text_block(const std::string& text) {
  return {{"text", text}};
}

Json heading_block(const std::string& text) {
  return {{"heading", text}};
}

Json table_block(const std::string& caption, const std::vector<Column>& columns, Json rows) {
  Json heads = Json::array();
  for (const Column& c : columns) {
    heads.push_back({{"key", c.key}, {"name", c.name}, {"unit", c.unit}, {"digits", c.digits}});
  }
  return {{"table", {{"caption", caption}, {"columns", heads}, {"rows", std::move(rows)}}}};
}

Json figure_block(const std::string& file, const std::string& caption, const std::string& alt) {
  return {{"figure", {{"file", file}, {"caption", caption}, {"alt", alt}}}};
}

PartFolder::PartFolder(const std::string& folder) : folder_(folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder)) {
    throw InputError(fmt::format("the folder {} cannot be created: {}; name another one", folder,
                                 failure ? failure.message() : "a file has this name"));
  }
  check_writable(path("part.json"));
}

std::string PartFolder::path(const std::string& file) const {
  return (fs::path(folder_) / file).string();
}

std::optional<Part> PartFolder::read(const std::string& name, const Json& asked) const {
  const std::string file = path(name + ".json");
  if (!fs::is_regular_file(file)) return std::nullopt;
  // a file that is not ours, or was edited, will be regenerated
  Json document = Json::parse(read_file(file, kMaxJsonBytes, Empty::Allowed), nullptr, false);
  if (!document.is_object() || document.value("format", "") != "prostm-report-part/1")
    return std::nullopt;
  if (!document.contains("asked") || document["asked"] != asked) return std::nullopt;
  if (!has_files(document, folder_)) return std::nullopt;
  return Part{name, std::move(document)};
}

void PartFolder::write(const Part& part) const {
  write_file(path(part.name + ".json"), to_text(part.document));
}

}  // namespace prostm::report
