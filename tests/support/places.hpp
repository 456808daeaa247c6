#pragma once
/// Where files of this checkout and beside it lie.

#include <string>

namespace prostm::test {

std::string source_file(const std::string& name);  ///< of the project, by its path in the checkout
std::string shared_file(const std::string& name);  ///< relative to ../shared; may not be there

}  // namespace prostm::test
