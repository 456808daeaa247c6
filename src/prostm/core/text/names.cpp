#include "prostm/core/text/names.hpp"

#include <stdexcept>

#include "prostm/core/text/nearest_name.hpp"

namespace prostm {

std::string one_of(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += names[i];
  }
  return text;
}

std::string listed(std::span<const std::string> entries, std::string_view conjunction) {
  std::string text;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i > 0) text += entries.size() > 2 ? ", " : " ";
    if (i > 0 && i + 1 == entries.size()) text += std::string(conjunction) + " ";
    text += entries[i];
  }
  return text;
}

std::string must_be(std::string_view name, std::span<const std::string_view> names) {
  return "must be " + one_of(names) + did_you_mean(name, {names.begin(), names.end()});
}

void refuse_name(const char* what, std::string_view name, std::span<const std::string_view> names) {
  throw std::invalid_argument(std::string(what) + " \"" + std::string(name) + "\" is unknown: it " +
                              must_be(name, names));
}

}  // namespace prostm
