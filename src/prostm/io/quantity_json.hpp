#pragma once
/// The quantities of a result as JSON.

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/quantity.hpp"

namespace prostm {

/// {"name": value in the file's unit, …}, with an object for each group; non-finite values are
/// null, or omitted if optional.
template <class S>
nlohmann::ordered_json quantities_to_json(const S& s) {
  auto document = nlohmann::ordered_json::object();
  for (const Quantity<S>& quantity : quantities<S>()) {
    if (quantity.optional && std::isnan(value_of(quantity, s))) continue;
    auto& object = *quantity.group == '\0' ? document : document[quantity.group];
    visit_value(quantity, s, [&](auto value) {
      if constexpr (std::is_same_v<decltype(value), double>) {
        object[quantity.name] = quantity.scale * value;
      } else {
        object[quantity.name] = value;
      }
    });
  }
  return document;
}

}  // namespace prostm
