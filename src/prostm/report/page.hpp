#pragma once
/// The page of a report, made from the files of its parts and nothing else.

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "prostm/report/part.hpp"

namespace prostm::report {

/// Text in HTML: &, <, > and quotes are escaped.
std::string escaped(std::string_view text);

/// A number with so many digits after the point, without the sign of a zero.
std::string rounded(double value, int digits);

/// Returns the bytes of a picture of a part.
using ReadPicture = std::function<std::string(const std::string& file)>;

/// One self-contained HTML page: a section for each part, with light and dark colours, and nothing
/// that is loaded from elsewhere. What it says of a part is a value of the part's document, and
/// each number stands in an element with the attributes data-from="NAME.json#/pointer" and
/// data-digits, where there are any.
/// @throws std::invalid_argument: a pointer that leads nowhere, a block of no kind, a cell that is
/// an array or an object.
std::string page_html(const std::string& title, std::span<const Part> parts,
                      const ReadPicture& read_picture);

}  // namespace prostm::report
