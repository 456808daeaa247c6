#pragma once
/// The page of a report, made only from the files of its parts.

#include <functional>
#include <span>
#include <string>

#include "prostm/report/part.hpp"

namespace prostm::report {

/// A number with `digits` decimals; zero has no sign.
std::string rounded(double value, int digits);

/// Returns the bytes of a picture of a part.
using ReadPicture = std::function<std::string(const std::string& file)>;

/// One self-contained HTML page, with a section for each part that has blocks and light and dark
/// colours; nothing is loaded from elsewhere. All content is taken from the parts' documents; each
/// number is in an element with the attribute data-from="NAME.json#/pointer" and, if its digits are
/// given, data-digits. Findings, verdicts and blocks with "open": true are shown at once, all
/// others are in an element that opens. @throws std::invalid_argument: a pointer to a missing
/// value, an unknown kind of block, a cell that is an array or an object.
std::string page_html(const std::string& title, std::span<const Part> parts,
                      const ReadPicture& read_picture);

}  // namespace prostm::report
