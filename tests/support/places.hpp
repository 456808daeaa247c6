#pragma once
/// Paths of files in and next to this checkout.

#include <string>

namespace prostm::test {

std::string source_file(const std::string& name);  ///< path of a project's file
std::string shared_file(const std::string& name);  ///< relative to ../shared; may be missing

}  // namespace prostm::test
