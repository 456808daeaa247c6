#pragma once
/// What is said of a name that is not known: which one may have been meant.

#include <string>
#include <string_view>
#include <vector>

namespace prostm {

/// A name from a file as it may stand in a message: not too long.
std::string shown_name(std::string_view name);

/// "did you mean …", or all that there is when nothing is near.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace prostm
