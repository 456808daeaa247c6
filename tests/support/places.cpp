// The one source that the checkout's own path is compiled into, so that a compiler's cache serves
// any other folder's tests.
#include "support/places.hpp"

namespace prostm::test {

std::string source_file(const std::string& name) {
  return std::string(PROSTM_SOURCE_DIR) + "/" + name;
}

std::string shared_file(const std::string& name) {
  return source_file("../shared/" + name);
}

}  // namespace prostm::test
