#include "prostm/core/file/file_kind.hpp"

#include <algorithm>
#include <array>

namespace prostm {

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark("\xEF\xBB\xBF");
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view kind_by_content(std::string_view bytes) {
  constexpr std::string_view kHdf5("\x89HDF\r\n\x1a\n"), kPng("\x89PNG\r\n\x1a\n"),
      kNpy("\x93NUMPY"), kZip("PK\x03\x04", 4);
  if (bytes.starts_with(kHdf5)) return "an HDF5 file";
  if (bytes.starts_with(kPng)) return "a PNG picture";
  if (bytes.starts_with(kNpy)) return "an NPY file";
  if (bytes.starts_with(kZip)) return "a zip archive";
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    return "text in UTF-16 (save it as UTF-8)";
  bytes = without_mark(bytes);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first != bytes.npos && bytes[first] == '{') return "JSON";
  return {};
}

std::string_view words_of_format(std::string_view format) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kFormats = {
      {{"prostm-field/1", "a field, for prostm plan"},
       {"prostm-plan/1", "a plan, for prostm field"},
       {"prostm-foci/1", "focal points, for prostm solve"},
       {"prostm-drives/1", "drives of transducers, from prostm solve"},
       {"prostm-array/1", "an array, for --array"},
       {"prostm-pose/1", "the pose of a tracker, for --tracker"},
       {"prostm-run/1", "the summary of a run"},
       {"hand-frames", "a recording of hands, for --hand"}}};
  const auto* const at = std::find_if(kFormats.begin(), kFormats.end(),
                                      [&](const auto& known) { return known[0] == format; });
  return at == kFormats.end() ? std::string_view() : (*at)[1];
}

std::string is_not(std::string_view bytes, std::string_view wanted) {
  const std::string_view kind = kind_by_content(bytes);
  const std::string end = "not " + std::string(wanted);
  return kind.empty() || kind == wanted ? "is " + end : "is " + std::string(kind) + ", " + end;
}

}  // namespace prostm
