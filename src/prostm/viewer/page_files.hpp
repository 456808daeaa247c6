#pragma once
/// The files of the page, as they were built from web/ and put into the program.

#include <span>
#include <string_view>

namespace prostm {

struct PageFile {
  std::string_view path;                 ///< as in a request: "/", "/page.js", …
  std::string_view type;                 ///< its media type, for Content-Type
  std::span<const unsigned char> bytes;  ///< the whole file
};

/// Every file of the page; none when the program was built without it (PROSTM_PAGE=OFF).
std::span<const PageFile> page_files();

}  // namespace prostm
