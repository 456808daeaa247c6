#include "prostm/core/require.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace prostm {
namespace {

/// Returns the message with which `check` rejects a value; empty if it accepts.
std::string refusal(const std::function<void()>& check) {
  try {
    check();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(RequireBetween, AcceptsBothBoundsAndAllValuesBetween) {
  for (const double x : {0.1, 0.3, 0.6}) {
    EXPECT_EQ(refusal([&] { require_between("height", x, 0.1, 0.6, "m"); }), "");
  }
  for (const int n : {1, 20, 50}) {
    EXPECT_EQ(refusal([&] { require_between("clusters", n, 1, 50); }), "");
  }
}

TEST(RequireBetween, ReportsTheValueTheBoundsAndTheUnit) {
  EXPECT_EQ(refusal([] { require_between("height", 1.0, 0.1, 0.6, "m"); }),
            "height = 1 m must be between 0.1 and 0.6 m");
  EXPECT_EQ(refusal([] { require_between("gain", -0.5, 0.01, 100.0); }),
            "gain = -0.5 must be between 0.01 and 100");
  EXPECT_EQ(refusal([] { require_between("clusters", 51, 1, 50); }),
            "clusters = 51 must be between 1 and 50");
  EXPECT_EQ(refusal([] { require_between("late", 0, 1, 9, "blocks"); }),
            "late = 0 blocks must be between 1 and 9 blocks");
}

TEST(RequireBetween, PrintsEnoughDigitsToDistinguishValueAndBound) {
  EXPECT_EQ(refusal([] { require_between("gain", std::nextafter(100.0, 200.0), 1e-6, 100.0); }),
            "gain = 100.00000000000001 must be between 1e-6 and 100");
  EXPECT_EQ(refusal([] { require_between("sigma", 0.0, 0.0001, 1e300); }),
            "sigma = 0 must be between 0.0001 and 1e300");
}

TEST(RequireBetween, RejectsNonFiniteValuesWithoutComparing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal([] {
              require_between("speed", std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0, "m/s");
            }),
            "speed = nan m/s must be between 0 and 1 m/s");
  EXPECT_EQ(refusal([] { require_between("speed", kInfinity, 0.0, kInfinity); }),
            "speed = inf must be between 0 and inf");
}

}  // namespace
}  // namespace prostm
