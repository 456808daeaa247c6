// The only source that contains the checkout's path, so that a compiler cache serves other folders'
// tests too.
#include "support/places.hpp"

namespace prostm::test {

std::string source_file(const std::string& name) {
  return std::string(PROSTM_SOURCE_DIR) + "/" + name;
}

std::string shared_file(const std::string& name) {
  return source_file("../shared/" + name);
}

}  // namespace prostm::test
