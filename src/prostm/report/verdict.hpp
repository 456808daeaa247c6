#pragma once
/// Comparisons of a report's numbers with published values, in words.

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace prostm::report {

/// Outcome of a comparison; the least convenient one is first.
enum class Agreement { Differs, NotComparable, Agrees };
/// "differs", "not comparable", "agrees"
std::string to_string(Agreement agreement);

/// A published value or interval, in the unit of the compared value; a bound may be infinite.
struct Published {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct Verdict {
  Agreement agreement = Agreement::NotComparable;
  std::string text;  ///< one sentence
};

/// How a number is written: decimals, and the unit behind it with its blank, such as " m/s".
struct Shown {
  int digits = 1;
  std::string unit = {};
};

/// Compares a number with a published interval, e.g. "A circle of 100 mm is strongest at 9.0 m/s;
/// published: 5.0 to 8.0 m/s, so it is 1.0 m/s too high." A number agrees if it lies within the
/// interval after rounding both.
/// @param statement text before the number, such as "A circle of 100 mm is strongest at".
Verdict compare(const std::string& statement, double value, Published published,
                const Shown& shown);

/// @param why a sentence.
Verdict not_comparable(const std::string& why);

/// Adds verdicts to a list of blocks, the least convenient first.
void add_verdicts(nlohmann::ordered_json& blocks, std::vector<Verdict> verdicts);

}  // namespace prostm::report
