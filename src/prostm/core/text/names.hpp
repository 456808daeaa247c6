#pragma once
/// Names of enum values in files, on the command line and in Python.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace prostm {

/// An std::array of names in the order of the values, which start from 0; specialised next to each
/// enum with names.
template <class E>
inline constexpr int kNames = 0;

template <class E>
constexpr std::string_view name_of(E value) {
  return kNames<E>[static_cast<std::size_t>(value)];
}

/// Returns "a, b or c".
std::string one_of(std::span<const std::string_view> names);

/// Returns "a, b, or c", "a or b", or "a", with the given conjunction. For help texts.
std::string listed(std::span<const std::string> entries, std::string_view conjunction = "or");

/// Returns "must be a, b or c", and for a name similar to one of them also "; did you mean "b"?".
std::string must_be(std::string_view name, std::span<const std::string_view> names);

/// Returns the value with this name, or nothing.
template <class E>
std::optional<E> value_named(std::string_view name) {
  const auto& names = kNames<E>;
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<E>(at - names.begin());
}

/// @throws std::invalid_argument "preset \"x\" is unknown: it must be …".
[[noreturn]] void refuse_name(const char* what, std::string_view name,
                              std::span<const std::string_view> names);

/// @param what the kind of name, e.g. "preset". @throws as refuse_name() does.
template <class E>
E from_name(std::string_view name, const char* what) {
  if (const auto value = value_named<E>(name)) return *value;
  refuse_name(what, name, kNames<E>);
}

}  // namespace prostm
