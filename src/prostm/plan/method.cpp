#include "prostm/plan/method.hpp"

#include <stdexcept>

namespace prostm {

Method method_from_name(const std::string& name) {
  if (name == "pro-stm") return Method::ProStm;
  if (name == "am") return Method::Am;
  throw std::invalid_argument("method '" + name + "' is unknown: it must be pro-stm or am");
}

std::string to_string(Method method) {
  return method == Method::Am ? "am" : "pro-stm";
}

}  // namespace prostm
