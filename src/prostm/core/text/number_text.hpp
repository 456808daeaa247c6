#pragma once
/// Numbers in messages and lists.

#include <string>

namespace prostm {

/// The fewest digits that read back as the same number: "0.0086", "2147483647", "1e300".
std::string number_text(double value);

/// A value and the bound that it violates, as text.
struct ComparedText {
  std::string value, bound;
};
/// Prints both with enough decimals to distinguish them, at least `decimals`: "129.96" and
/// "130.00".
ComparedText compared_text(double value, double bound, int decimals);

}  // namespace prostm
