#pragma once
/// A printable copy of a page, made by a browser.

#include <optional>
#include <string>

namespace prostm::app {

/// Returns the first browser on PATH that can print a page: Chromium, by its various names.
std::optional<std::string> find_browser();

/// Lets the browser print a page as a PDF. @return whether it succeeded; its messages are
/// discarded.
bool print_page(const std::string& browser, const std::string& page, const std::string& pdf);

}  // namespace prostm::app
