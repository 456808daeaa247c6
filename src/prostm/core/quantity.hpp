#pragma once
/// How the numbers of a result are listed once, and written, drawn, shown and merged from that one
/// list. A new number is one line of a list and its computation.

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <variant>

namespace prostm {

/// Which way a number is better.
enum class Better : std::uint8_t { Neither, Less, More };

/// What becomes of a number when the results of two parts of a run are put together.
enum class Merge : std::uint8_t { Sum, Most, Newest };

/// One number of the result S.
template <class S>
struct Quantity {
  using Member = std::variant<double S::*, std::int64_t S::*, int S::*, double (*)(const S&),
                              std::int64_t (*)(const S&)>;
  const char* name;  ///< in files and in Python
  const char* unit;  ///< in files; empty for a plain number
  const char* help;
  Member value;  ///< where it is, or how it follows from what is there
  Better better = Better::Neither;
  Merge merge = Merge::Sum;
  double scale = 1.0;      ///< a file's value over that in SI, 1e3 for ms
  const char* group = "";  ///< in JSON, the object that it is in; empty: none
  bool optional = false;   ///< left out of files where nobody asked for it: NaN there
  const char* label = "";  ///< heading of its column in tables and figures; empty: it has none
};

/// The list of S, specialised where S is.
template <class S>
std::span<const Quantity<S>> quantities();

/// Calls `use` with the number itself, in SI: a double or a std::int64_t.
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

/// In SI.
template <class S>
double value_of(const Quantity<S>& quantity, const S& s) {
  return visit_value(quantity, s, [](auto value) { return static_cast<double>(value); });
}

/// Puts `more`, of what came later, to `sum`. What follows from other numbers is left to them.
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
