/// Exit status of benchmarks and labs.

#include "program.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "prostm/core/input_error.hpp"

namespace prostm::bench {
namespace {

template <class Error>
int status_after() {
  std::array<char, 5> name{"test"};
  std::array<char*, 2> arguments{name.data(), nullptr};
  Program program("a test");
  return program.run(1, arguments.data(), []() -> std::vector<Row> { throw Error("a reason"); });
}

TEST(LabProgram, EndsWithTwoForRejectedInput) {
  EXPECT_EQ(status_after<InputError>(), 2);
  EXPECT_EQ(status_after<std::invalid_argument>(), 2) << "an unknown name";
}

}  // namespace
}  // namespace prostm::bench
