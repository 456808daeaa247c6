// The only source that contains the checkout's path, so that a compiler cache also serves tests
// in other folders.
#include "support/places.hpp"

namespace prostm::test {

std::string source_file(const std::string& name) {
  return std::string(PROSTM_SOURCE_DIR) + "/" + name;
}

std::string shared_file(const std::string& name) {
  return source_file("../shared/" + name);
}

}  // namespace prostm::test
