#pragma once
/// Numbers in messages and lists.

#include <string>

namespace prostm {

/// The fewest digits that read back as the same number: "0.0086", "2147483647", "1e300".
std::string number_text(double value);

}  // namespace prostm
