#include "prostm/core/names.hpp"

#include <stdexcept>

namespace prostm {

std::string one_of(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += names[i];
  }
  return text;
}

void refuse_name(const char* what, std::string_view name, std::span<const std::string_view> names) {
  throw std::invalid_argument(std::string(what) + " \"" + std::string(name) +
                              "\" is unknown: it must be " + one_of(names));
}

}  // namespace prostm
