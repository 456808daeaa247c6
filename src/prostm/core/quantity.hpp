#pragma once
/// Lists of the numbers in a result, from which they are written, drawn, shown and merged. A new
/// number needs only one line in the list and its computation.

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <variant>

namespace prostm {

/// The direction in which a number is better.
enum class Better : std::uint8_t { Neither, Less, More };

/// Rule for combining a number when the results of two parts of a run are merged.
enum class Merge : std::uint8_t { Sum, Most, Newest };

/// One number of the result S.
template <class S>
struct Quantity {
  using Member = std::variant<double S::*, std::int64_t S::*, int S::*, double (*)(const S&),
                              std::int64_t (*)(const S&)>;
  const char* name;  ///< in files and in Python
  const char* unit;  ///< in files; empty if dimensionless
  const char* help;
  Member value;  ///< the member, or a function of the members
  Better better = Better::Neither;
  Merge merge = Merge::Sum;
  double scale = 1.0;      ///< factor from SI to the unit in files, e.g. 1e3 for ms
  const char* group = "";  ///< JSON object that holds it; empty: the document
  bool optional = false;   ///< NaN, and omitted from files, unless requested
  const char* label = "";  ///< column heading in tables and figures; empty: no column
};

/// The list for S, specialised beside S.
template <class S>
std::span<const Quantity<S>> quantities();

/// Calls `use` with the number in SI, as a double or a std::int64_t.
template <class S, class Use>
decltype(auto) visit_value(const Quantity<S>& quantity, const S& s, const Use& use) {
  return std::visit(
      [&](auto value) {
        if constexpr (std::is_same_v<decltype(value), double S::*>) {
          return use(s.*value);
        } else if constexpr (std::is_member_object_pointer_v<decltype(value)>) {
          return use(static_cast<std::int64_t>(s.*value));
        } else {
          return use(value(s));
        }
      },
      quantity.value);
}

/// Returns the number in SI.
template <class S>
double value_of(const Quantity<S>& quantity, const S& s) {
  return visit_value(quantity, s, [](auto value) { return static_cast<double>(value); });
}

/// Merges `more`, the later part, into `sum`. Computed numbers are not merged; they follow from the
/// members.
template <class S>
void merge(const S& more, S& sum) {
  for (const Quantity<S>& quantity : quantities<S>()) {
    std::visit(
        [&](auto member) {
          if constexpr (std::is_member_object_pointer_v<decltype(member)>) {
            if (quantity.merge == Merge::Sum) sum.*member += more.*member;
            if (quantity.merge == Merge::Most) sum.*member = std::max(sum.*member, more.*member);
            if (quantity.merge == Merge::Newest) sum.*member = more.*member;
          }
        },
        quantity.value);
  }
}

}  // namespace prostm
