#pragma once
/// The files of the page, built from web/ and embedded in the program.

#include <span>
#include <string_view>

namespace prostm {

struct PageFile {
  std::string_view path;                 ///< as in a request: "/", "/page.js", …
  std::string_view type;                 ///< its media type, for Content-Type
  std::span<const unsigned char> bytes;  ///< the whole file
};

/// All files of the page; none if the program was built without it (PROSTM_PAGE=OFF).
std::span<const PageFile> page_files();

}  // namespace prostm
