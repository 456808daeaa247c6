/// Runs all tests with floating-point traps on: an invalid operation, a division by zero or an
/// overflow stops the test.

#include <gtest/gtest.h>

#include <cfenv>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  return RUN_ALL_TESTS();
}
