#include "prostm/core/file_kind.hpp"

namespace prostm {

std::string_view kind_by_content(std::string_view bytes) {
  constexpr std::string_view kHdf5("\x89HDF\r\n\x1a\n"), kPng("\x89PNG\r\n\x1a\n"),
      kNpy("\x93NUMPY");
  if (bytes.starts_with(kHdf5)) return "an HDF5 file";
  if (bytes.starts_with(kPng)) return "a PNG picture";
  if (bytes.starts_with(kNpy)) return "an NPY file";
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first != bytes.npos && bytes[first] == '{') return "JSON";
  return {};
}

std::string is_not(std::string_view bytes, std::string_view wanted) {
  const std::string_view kind = kind_by_content(bytes);
  const std::string end = "not " + std::string(wanted);
  return kind.empty() || kind == wanted ? "is " + end : "is " + std::string(kind) + ", " + end;
}

}  // namespace prostm
