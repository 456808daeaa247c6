#include "prostm/core/text/number_text.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace prostm {
namespace {

TEST(ComparedText, HasEnoughDigitsToDistinguishAValueFromItsBound) {
  struct Case {
    double value, bound;
    int decimals;
    const char *value_text, *bound_text;
  };
  for (const Case& c :
       {Case{129.96, 130.0, 0, "129.96", "130.00"}, Case{100.0, 130.0, 0, "100", "130"},
        Case{0.0504, 0.05, 2, "0.0504", "0.0500"}, Case{0.3, 0.05, 2, "0.30", "0.05"},
        Case{15.2, 15.0, 0, "15.2", "15.0"}, Case{3.0, 3.0, 1, "3.0", "3.0"}}) {
    const ComparedText text = compared_text(c.value, c.bound, c.decimals);
    EXPECT_EQ(text.value, c.value_text);
    EXPECT_EQ(text.bound, c.bound_text);
  }
}

TEST(ComparedText, DistinguishesNearlyEqualNumbers) {
  for (double difference = 1e-1; difference > 1e-12; difference *= 0.1) {
    const auto [value, bound] = compared_text(1.0 + difference, 1.0, 0);
    EXPECT_NE(value, bound) << difference;
  }
}

}  // namespace
}  // namespace prostm
