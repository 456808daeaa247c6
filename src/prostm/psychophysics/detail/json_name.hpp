#pragma once
/// Values of enums with names, from JSON.

#include "prostm/core/text/json.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// Returns the value that a text names. @throws InputError for another text.
template <class E>
E named_value(const JsonNode& node) {
  const auto value = value_named<E>(node.text());
  if (!value) node.fail(must_be(node.text(), kNames<E>));
  return *value;
}

}  // namespace prostm
